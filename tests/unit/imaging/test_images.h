#pragma once
/// Images and calls shared by the tests of imaging.

#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen::testing {

/// Uniform random samples in [low, high].
inline Image random_image(int width, int height, int channels, float low, float high,
                          unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(low, high);
    Image image(width, height, channels);
    for (float& sample : image.samples) sample = value(random);
    return image;
}

/// Smooth, like a photograph, for JPEG.
inline Image smooth_image(int width, int height, int channels) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int i = 0; i < channels; ++i) {
                image.pixel(x, y)[i] = (float(x) / float(width) * float(i + 1) / 4.0f +
                                        float(y) / float(height) / 4.0f);
            }
        }
    }
    return image;
}

inline EncodedImage random_codes(int width, int height, int channels, int bits, unsigned seed) {
    std::mt19937 random(seed);
    EncodedImage image{
        .width = width, .height = height, .channels = channels, .bits = bits, .samples = {}};
    for (int i = 0; i < width * height * channels; ++i) {
        image.samples.push_back(std::uint16_t(random() & (bits == 8 ? 0xffu : 0xffffu)));
    }
    return image;
}

inline std::string as_string(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Kind of the error that `call` throws; empty if it returns.
template <class Call>
std::optional<ErrorKind> error_of(Call call) {
    try {
        call();
    } catch (const Error& error) {
        return error.kind();
    }
    return std::nullopt;
}

}  // namespace alhazen::testing
