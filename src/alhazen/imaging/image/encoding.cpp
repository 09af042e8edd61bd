#include "alhazen/imaging/image/encoding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/imaging/image/code_lanes.h"
#include "alhazen/imaging/image/image.h"

namespace alhazen {

namespace {

std::uint32_t rounded(double c, int bits) {
    const std::uint32_t max = (std::uint32_t{1} << bits) - 1;
    if (!(c > 0.0)) return 0;  // NaN too
    if (c >= 1.0) return max;
    return std::uint32_t(std::floor(double(max) * c + 0.5));
}

void check_sizes(int width, int height, int channels, int bits) {
    if (width <= 0 || height <= 0) {
        throw Error(ErrorKind::Usage, "cannot encode a picture of " + std::to_string(width) +
                                          " x " + std::to_string(height) + " pixels");
    }
    if (channels < 1 || channels > 4) {
        throw Error(ErrorKind::Usage, "cannot encode a picture of " + std::to_string(channels) +
                                          " channels, expected 1 to 4");
    }
    if (bits != 8 && bits != 16) {
        throw Error(ErrorKind::Usage,
                    "cannot encode in " + std::to_string(bits) + " bits, expected 8 or 16");
    }
}

EncodedImage empty_encoded(int width, int height, int channels, int bits) {
    check_sizes(width, height, channels, bits);
    EncodedImage encoded{
        .width = width, .height = height, .channels = channels, .bits = bits, .samples = {}};
    encoded.samples.resize(std::size_t(width) * std::size_t(height) * std::size_t(channels));
    return encoded;
}

/// The 8-bit codes of the sRGB curve, found by their least values; the same codes as
/// `encode_channel` in a tenth of the time.
class SrgbCodes {
  public:
    SrgbCodes() {
        thresholds_[0] = 0.0;
        thresholds_[256] = std::numeric_limits<double>::infinity();
        for (std::uint32_t code = 1; code < 256; ++code) thresholds_[code] = least_with(code);
        for (std::size_t i = 0, code = 0; i < kSteps; ++i) {
            while (double(i) / kSteps >= thresholds_[code + 1]) ++code;
            first_[i] = std::uint8_t(code);
        }
    }

    [[nodiscard]] std::uint16_t code(double c) const {
        if (!(c > 0.0)) return 0;  // NaN too
        if (c >= 1.0) return 255;
        // In range: c * kSteps < kSteps. A step of c is less than a code (the curve's slope is at
        // most 12.92), so that it has one threshold at most.
        static_assert(12.92 * 255.0 < double(kSteps));
        const std::uint16_t first = first_.data()[int(c * kSteps)];
        return std::uint16_t(first + (c >= thresholds_.data()[first + 1] ? 1 : 0));
    }

  private:
    static constexpr std::size_t kSteps = 4096;

    /// Positive doubles are ordered as their bits are.
    static double least_with(std::uint32_t code) {
        const auto has = [&](std::uint64_t bits) {
            return encode_channel(std::bit_cast<double>(bits), Encoding::Srgb, 8) >= code;
        };
        auto below = std::bit_cast<std::uint64_t>(0.0), from = std::bit_cast<std::uint64_t>(1.0);
        // Near to where the inverse of the curve says.
        const double guess = linear_from_srgb((code - 0.5) / 255.0);
        const auto before = std::bit_cast<std::uint64_t>(guess * (1.0 - 0x1p-40));
        const auto behind = std::bit_cast<std::uint64_t>(guess * (1.0 + 0x1p-40));
        if (!has(before)) below = before;
        if (has(behind)) from = behind;
        while (from - below > 1) {
            const std::uint64_t middle = below + (from - below) / 2;
            (has(middle) ? from : below) = middle;
        }
        return std::bit_cast<double>(from);
    }

    std::array<double, 257> thresholds_{};
    std::array<std::uint8_t, kSteps> first_{};  ///< [c * kSteps] the code at the lower end
};

}  // namespace

double srgb_from_linear(double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

double linear_from_srgb(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

std::uint32_t encode_channel(double c, Encoding encoding, int bits) {
    const std::uint32_t max = (std::uint32_t{1} << bits) - 1;
    if (!(c > 0.0)) return 0;  // NaN too
    if (c >= 1.0) return max;
    if (encoding == Encoding::LinearTruncated) return std::uint32_t(std::floor(double(max) * c));
    return rounded(encoding == Encoding::LinearRounded ? c : srgb_from_linear(c), bits);
}

void encode(const double* rgb, Encoding encoding, int bits, std::span<std::uint16_t> codes) {
    if (encoding != Encoding::Srgb) {
        const double most = double((std::uint32_t{1} << bits) - 1);
        return linear_codes(rgb, most, encoding == Encoding::LinearRounded ? 0.5 : 0.0, codes);
    }
    if (bits == 8) {
        static const SrgbCodes kCodes;
        // Backgrounds repeat pixels.
        double last[3] = {0.0, 0.0, 0.0};
        std::uint16_t code[3] = {0, 0, 0};
        std::size_t i = 0;
        for (; i + 3 <= codes.size(); i += 3) {
            const double* const pixel = rgb + i;
            if (pixel[0] != last[0] || pixel[1] != last[1] || pixel[2] != last[2]) {
                for (int k = 0; k < 3; ++k) code[k] = kCodes.code(last[k] = pixel[k]);
            }
            std::copy_n(code, 3, codes.data() + i);
        }
        for (; i < codes.size(); ++i) codes.data()[i] = kCodes.code(rgb[i]);
        return;
    }
    // Caches the last codes: backgrounds repeat values, and the curve is expensive.
    double last[3] = {0.0, 0.0, 0.0};
    std::uint16_t code[3] = {0, 0, 0};
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const std::size_t channel = i % 3;
        if (rgb[i] != last[channel]) {
            last[channel] = rgb[i];
            code[channel] = std::uint16_t(encode_channel(rgb[i], encoding, bits));
        }
        codes[i] = code[channel];
    }
}

EncodedImage encode(const double* rgb, int width, int height, Encoding encoding, int bits) {
    EncodedImage encoded = empty_encoded(width, height, 3, bits);
    encode(rgb, encoding, bits, encoded.samples);
    return encoded;
}

EncodedImage encode(const Image& image, Encoding encoding, int bits) {
    EncodedImage encoded = empty_encoded(image.width, image.height, image.channels, bits);
    if (image.samples.size() != encoded.samples.size()) {
        throw Error(ErrorKind::Usage, "the picture has " + std::to_string(image.samples.size()) +
                                          " samples, expected " +
                                          std::to_string(encoded.samples.size()));
    }
    const auto channels = std::size_t(image.channels);
    const bool has_alpha = channels == 2 || channels == 4;
    for (std::size_t i = 0; i < encoded.samples.size(); ++i) {
        const double value = double(image.samples[i]);
        const bool is_alpha = has_alpha && i % channels == channels - 1;
        encoded.samples[i] =
            std::uint16_t(is_alpha || !image.linear ? rounded(value, bits)
                                                    : encode_channel(value, encoding, bits));
    }
    return encoded;
}

}  // namespace alhazen
