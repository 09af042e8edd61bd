#pragma once
/// An image in memory: float samples, interleaved, top row first.
///
/// Conventions: values are as in the file or from the renderer; `linear` tells whether they are
/// linear radiance (EXR, HDR, PFM, renders) or encoded for display (PNG, JPG, BMP: value / 255).

#include <algorithm>
#include <cstddef>
#include <vector>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// The pixels that a file holds of a picture whose other pixels are 0: the data window of an EXR
/// inside its display window. Of size 0: it holds all.
struct HeldPixels {
    int x0 = 0, y0 = 0, width = 0, height = 0;

    /// Of a file whose data window lies outside of its display window.
    [[nodiscard]] static constexpr HeldPixels none() { return {0, 0, -1, -1}; }
    [[nodiscard]] bool are_none() const { return width < 0; }
};
inline constexpr const char* kNoPixelsHeld =
    "the data window of the file lies outside of its display window: all pixels are 0";

struct Image {
    int width = 0, height = 0;
    int channels = 3;  ///< 1 grey, 2 grey + alpha, 3 RGB, 4 RGB + alpha
    bool linear = true;
    std::vector<float> samples;  ///< [height][width][channels]
    bool associated = false;     ///< colours are multiplied by alpha (premultiplied), as in EXR
    HeldPixels held;

    Image() = default;
    Image(int width_, int height_, int channels_)
        : width(width_),
          height(height_),
          channels(channels_),
          samples(std::size_t(width_) * std::size_t(height_) * std::size_t(channels_)) {}

    [[nodiscard]] float* pixel(int x, int y) {
        return samples.data() +
               (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels);
    }
    [[nodiscard]] const float* pixel(int x, int y) const {
        return samples.data() +
               (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels);
    }
    /// The colour of a pixel; grey is repeated in the three channels.
    [[nodiscard]] Rgb rgb(int x, int y) const {
        const float* p = pixel(x, y);
        return channels < 3 ? Rgb{p[0], p[0], p[0]} : Rgb{p[0], p[1], p[2]};
    }
};

/// The pixels that the file held; the image itself if it held all or none.
[[nodiscard]] inline Image held_part(const Image& image) {
    const HeldPixels& held = image.held;
    if (held.width <= 0) return image;
    Image part(held.width, held.height, image.channels);
    part.linear = image.linear;
    part.associated = image.associated;
    const std::size_t row = std::size_t(held.width) * std::size_t(image.channels);
    for (int y = 0; y < held.height; ++y) {
        std::copy_n(image.pixel(held.x0, held.y0 + y), row, part.pixel(0, y));
    }
    return part;
}

}  // namespace alhazen
