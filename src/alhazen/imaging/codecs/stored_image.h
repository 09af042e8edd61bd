#pragma once
/// An image in compact form: codes of 8 or 16 bits if they are exact, else floats.
///
/// Conventions: a code represents the float code / max, as image readers compute it, so that
/// storing and expanding an image changes no bit.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "alhazen/imaging/image/image.h"

namespace alhazen {

struct StoredImage {
    int width = 0, height = 0;
    int channels = 3;  ///< as in Image
    bool linear = true;
    /// [height][width][channels]
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> samples;
    bool associated = false;  ///< as in Image; only of floats
    HeldPixels held = {};

    [[nodiscard]] std::size_t memory_bytes() const;
    /// True if no pixel has an alpha below 1.
    [[nodiscard]] bool is_opaque() const;
    /// The pixel with an index in row order; grey is repeated, and a missing alpha is 1.
    /// `decode_srgb`: decode the colours to linear values by the sRGB curve; alpha is never
    /// decoded. Associated colours are divided by alpha, except where that is not positive.
    [[nodiscard]] Rgba pixel(std::size_t index, bool decode_srgb) const;
    /// Writes the values of `count` pixels, as `pixel` has them, in the image's channels:
    /// out[count][channels].
    void read_pixels(std::size_t first, std::size_t count, bool decode_srgb, double* out) const;
};

/// Stores an image that is not linear as codes of 8, or else 16, bits if every sample is such a
/// code; all other images as floats.
[[nodiscard]] StoredImage stored(Image image);
[[nodiscard]] Image expanded(StoredImage image);

/// With the colours multiplied by alpha; where that is not positive they stay.
[[nodiscard]] Image associated_copy(Image image);

}  // namespace alhazen
