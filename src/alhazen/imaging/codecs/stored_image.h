#pragma once
/// A picture that is kept: its samples as small as they are exact, codes of 8 or 16 bits or floats.
///
/// Conventions: a code stands for the float code / max, as picture readers give it, so that
/// storing and expanding a picture changes no bit.

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

    [[nodiscard]] std::size_t memory_bytes() const;
    /// No pixel has an alpha below 1.
    [[nodiscard]] bool is_opaque() const;
    /// One pixel, counted through the rows; grey is repeated, alpha is 1 where there is none.
    /// `decode_srgb`: the colours are made linear, by the sRGB curve; alpha never is.
    [[nodiscard]] Rgba pixel(std::size_t index, bool decode_srgb) const;
    /// The same values for a run of pixels, as many channels of each as there are:
    /// out[count][channels].
    void read_pixels(std::size_t first, std::size_t count, bool decode_srgb, double* out) const;
};

/// Bytes when every sample of a picture that is not linear is a code of 8 bits, shorts when of 16,
/// floats else.
[[nodiscard]] StoredImage stored(Image image);
[[nodiscard]] Image expanded(StoredImage image);

}  // namespace alhazen
