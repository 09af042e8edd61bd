#pragma once
/// False-colour images of one number per pixel, with the scale drawn below.
///
/// Conventions: values outside the scale get the colour of its nearer end; non-finite values are
/// black. The scale adds a strip below the picture and widens a narrow picture on the right.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "alhazen/imaging/image/encoding.h"
#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

struct ColorScale {
    enum class Colors {
        Heat,      ///< heat_color: larger is lighter
        NearGrey,  ///< white at `low`, dark grey at `high`
    };
    double low = 0, high = 1;
    Colors colors = Colors::Heat;
    std::string title;  ///< only characters of tiny_font
    bool drawn = true;  ///< false: omit the scale
};

/// An image of 8-bit sRGB. `values` are [height][width].
[[nodiscard]] EncodedImage false_color(std::span<const float> values, int width, int height,
                                       const ColorScale& scale);

/// The scale's colour at `t` in [0, 1], as sRGB display values.
[[nodiscard]] Rgb scale_color(ColorScale::Colors colors, double t);

/// A colour that distinguishes a number from its neighbours; black for 0. sRGB codes, 0 to 255.
[[nodiscard]] std::array<std::uint16_t, 3> id_color(std::uint32_t id);

}  // namespace alhazen
