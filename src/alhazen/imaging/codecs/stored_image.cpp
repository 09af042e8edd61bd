#include "alhazen/imaging/codecs/stored_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

namespace {

/// The float of a code in [0, max].
template <class Code>
float value_of(Code code) {
    constexpr float kMax = sizeof(Code) == 1 ? 255.0f : 65535.0f;
    return float(code) / kMax;
}
template <>
float value_of(float sample) {
    return sample;
}

template <class Code>
std::vector<double> decoded_codes() {
    std::vector<double> values(std::size_t{1} << (8 * sizeof(Code)));
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = linear_from_srgb(double(value_of(static_cast<Code>(i))));
    }
    return values;
}

/// [code] the linear value.
template <class Code>
const double* decoding() {
    static const std::vector<double> values = decoded_codes<Code>();
    return values.data();
}
double decoded(std::uint8_t code) {
    return decoding<std::uint8_t>()[code];
}
double decoded(std::uint16_t code) {
    return decoding<std::uint16_t>()[code];
}
double decoded(float sample) {
    return linear_from_srgb(double(sample));
}

/// Converts all samples to codes; false if one of them is not a code.
template <class Code>
bool to_codes(const std::vector<float>& samples, std::vector<Code>& codes) {
    constexpr float kMax = sizeof(Code) == 1 ? 255.0f : 65535.0f;
    codes.resize(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const float s = samples[i];
        if (!(s >= 0.0f && s <= 1.0f)) return false;
        codes[i] = static_cast<Code>(std::lround(s * kMax));
        if (value_of(codes[i]) != s) return false;
    }
    return true;
}

/// Copies a pixel of colours that are multiplied by the last channel, alpha, without the product.
void copy_straight(const float* from, std::size_t channels, float* to) {
    std::copy_n(from, channels, to);
    const float alpha = from[channels - 1];
    if (!(alpha > 0.0f)) return;
    for (std::size_t k = 0; k + 1 < channels; ++k) {
        const float straight = from[k] / alpha;
        if (std::isfinite(straight)) to[k] = straight;
    }
}

template <class Sample>
Rgba pixel_of(const Sample* p, int channels, bool decode_srgb) {
    const auto color = [&](int i) { return decode_srgb ? decoded(p[i]) : double(value_of(p[i])); };
    if (channels < 3) {
        const double grey = color(0);
        return {grey, grey, grey, channels == 2 ? double(value_of(p[1])) : 1.0};
    }
    return {color(0), color(1), color(2), channels == 4 ? double(value_of(p[3])) : 1.0};
}

}  // namespace

std::size_t StoredImage::memory_bytes() const {
    return std::visit([](const auto& s) { return s.size() * sizeof(s[0]); }, samples);
}

Rgba StoredImage::pixel(std::size_t index, bool decode_srgb) const {
    const std::size_t first = index * std::size_t(channels);
    // std::get_if: GCC does not always inline the function table of std::visit.
    if (const auto* bytes = std::get_if<0>(&samples)) {
        return pixel_of(bytes->data() + first, channels, decode_srgb);
    }
    if (const auto* words = std::get_if<1>(&samples)) {
        return pixel_of(words->data() + first, channels, decode_srgb);
    }
    const float* const floats = std::get<2>(samples).data() + first;
    if (associated) {
        std::array<float, 4> straight{};
        copy_straight(floats, std::size_t(channels), straight.data());
        return pixel_of(straight.data(), channels, decode_srgb);
    }
    return pixel_of(floats, channels, decode_srgb);
}

void StoredImage::read_pixels(std::size_t first, std::size_t count, bool decode_srgb,
                              double* out) const {
    const auto step = std::size_t(channels);
    // Alpha is never decoded.
    const std::size_t colors = channels == 2 || channels == 4 ? step - 1 : step;
    std::visit(
        [&](const auto& all) {
            const auto* in = all.data() + first * step;
            for (std::size_t i = 0; i < count; ++i, in += step, out += step) {
                auto* from = in;
                [[maybe_unused]] std::array<float, 4> straight;
                if constexpr (std::is_same_v<decltype(in), const float*>) {
                    if (associated) {
                        copy_straight(in, step, straight.data());
                        from = straight.data();
                    }
                }
                for (std::size_t k = 0; k < step; ++k) {
                    out[k] =
                        decode_srgb && k < colors ? decoded(from[k]) : double(value_of(from[k]));
                }
            }
        },
        samples);
}

bool StoredImage::is_opaque() const {
    if (channels != 2 && channels != 4) return true;
    return std::visit(
        [&](const auto& all) {
            const auto step = std::size_t(channels);
            for (std::size_t i = step - 1; i < all.size(); i += step) {
                if (value_of(all[i]) < 1.0f) return false;
            }
            return true;
        },
        samples);
}

StoredImage stored(Image image) {
    StoredImage result{image.width, image.height, image.channels, image.linear, {}};
    result.held = image.held;
    if (!image.linear) {
        if (std::vector<std::uint8_t> bytes; to_codes(image.samples, bytes)) {
            result.samples = std::move(bytes);
            return result;
        }
        if (std::vector<std::uint16_t> shorts; to_codes(image.samples, shorts)) {
            result.samples = std::move(shorts);
            return result;
        }
    }
    result.samples = std::move(image.samples);
    result.associated = image.associated && (image.channels == 2 || image.channels == 4);
    return result;
}

Image expanded(StoredImage image) {
    Image result;
    result.width = image.width;
    result.height = image.height;
    result.channels = image.channels;
    result.linear = image.linear;
    result.associated = image.associated;
    result.held = image.held;
    if (auto* floats = std::get_if<std::vector<float>>(&image.samples)) {
        result.samples = std::move(*floats);
        return result;
    }
    std::visit(
        [&](const auto& samples) {
            result.samples.reserve(samples.size());
            for (const auto sample : samples) result.samples.push_back(value_of(sample));
        },
        image.samples);
    return result;
}

Image associated_copy(Image image) {
    if (image.channels != 2 && image.channels != 4) return image;
    image.associated = true;
    const auto step = std::size_t(image.channels);
    for (std::size_t i = step - 1; i < image.samples.size(); i += step) {
        const float alpha = image.samples[i];
        if (!(alpha > 0.0f)) continue;
        for (std::size_t k = i - (step - 1); k < i; ++k) image.samples[k] *= alpha;
    }
    return image;
}

}  // namespace alhazen
