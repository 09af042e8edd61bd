#pragma once
/// An image in compact form: codes of 8 or 16 bits where these are exact, else floats.
///
/// Conventions: a code represents the float code / max, as image readers give it, so that storing
/// and expanding an image changes no bit.

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
    /// One pixel, by its index in row order; grey is repeated, alpha is 1 where there is none.
    /// `decode_srgb`: decodes the colours to linear by the sRGB curve; alpha is never decoded.
    [[nodiscard]] Rgba pixel(std::size_t index, bool decode_srgb) const;
    /// The same values for a run of pixels, in the image's channels: out[count][channels].
    void read_pixels(std::size_t first, std::size_t count, bool decode_srgb, double* out) const;
};

/// Stores an image that is not linear as 8-bit codes, or else 16-bit codes, when every sample is
/// one; all others as floats.
[[nodiscard]] StoredImage stored(Image image);
[[nodiscard]] Image expanded(StoredImage image);

}  // namespace alhazen
