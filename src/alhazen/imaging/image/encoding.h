#pragma once
/// Converts linear values to the integer codes of display images (PNG, JPG).
///
/// Source: IEC 61966-2-1 (sRGB), the transfer curve.
/// Conventions: a code is in [0, 2^bits - 1]; values are clamped to [0, 1]; NaN becomes 0. Codes
/// are computed from doubles, because a truncated code may change if its value is first rounded to
/// float.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace alhazen {

struct Image;

/// The conversion of linear values to integers.
enum class Encoding {
    LinearTruncated,  ///< floor(max * clamp(c, 0, 1)): uw_yaml's renderer and old formats
    LinearRounded,    ///< the nearest code: BRL-CAD
    Srgb,             ///< IEC 61966-2-1 transfer curve, rounded to nearest
};

/// An image of integer codes, top row first: the exact content of a PNG.
struct EncodedImage {
    int width = 0, height = 0;
    int channels = 3;                         ///< 1 grey, 2 grey + alpha, 3 RGB, 4 RGB + alpha
    int bits = 8;                             ///< 8 or 16
    std::vector<std::uint16_t> samples = {};  ///< [height][width][channels]
};

/// An image of integer codes, made row by row, so that the codes of the whole picture are never in
/// memory at once.
struct CodeRows {
    int width = 0, height = 0;
    int channels = 3;
    int bits = 8;
    /// Writes the codes of row `y`, [width][channels]. Called from several threads, in any order.
    std::function<void(int y, std::span<std::uint16_t> codes)> fill = {};
};

/// The sRGB curve and its inverse, for c in [0, 1]; values above 1 follow the same curve, those
/// below 0 its linear part.
[[nodiscard]] double srgb_from_linear(double c);
[[nodiscard]] double linear_from_srgb(double c);

/// The code of `c`. Precondition: `bits` is in 1..16.
[[nodiscard]] std::uint32_t encode_channel(double c, Encoding encoding, int bits);

/// Writes as many codes as `codes` holds, a multiple of three, from the values at `rgb`; `bits` is
/// 8 or 16.
void encode(const double* rgb, Encoding encoding, int bits, std::span<std::uint16_t> codes);

/// The codes of `rgb` [height][width][3]. Throws Error (Usage) if a side is not positive or `bits`
/// is neither 8 nor 16.
[[nodiscard]] EncodedImage encode(const double* rgb, int width, int height, Encoding encoding,
                                  int bits);

/// The codes of an image. The values of an image that is not linear are only rounded, as they are
/// encoded already. Alpha is never transformed by the transfer curve. Throws Error (Usage) as the
/// overload above, or if the samples do not fit the sizes.
[[nodiscard]] EncodedImage encode(const Image& image, Encoding encoding, int bits);

}  // namespace alhazen
