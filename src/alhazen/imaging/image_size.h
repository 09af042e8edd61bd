#pragma once
/// What every picture reader does with the sizes in a header, and how it reports bad data.

#include <cstdint>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/imaging/image_io.h"

namespace alhazen {

/// Ends the reading of a malformed picture.
[[noreturn]] inline void bad_image(const std::string& name, const std::string& what) {
    throw Error(ErrorKind::Scene, what, {name, 0, 0});
}

/// Throws Error: Scene for an empty picture, Resource for one beyond the limits.
inline void check_image_size(std::int64_t width, std::int64_t height, const ImageLimits& limits,
                             const std::string& name) {
    const auto size = [&] { return std::to_string(width) + " x " + std::to_string(height); };
    if (width <= 0 || height <= 0) bad_image(name, "the picture is empty (" + size() + " pixels)");
    if (width > limits.max_side || height > limits.max_side ||
        std::uint64_t(width) * std::uint64_t(height) > limits.max_pixels) {
        throw Error(ErrorKind::Resource,
                    "the picture is too large: " + size() + " pixels, allowed are sides of " +
                        std::to_string(limits.max_side) + " and " +
                        std::to_string(limits.max_pixels) + " pixels",
                    {name, 0, 0});
    }
}

/// A picture of a checked size whose rows are still to be appended: memory that is reserved but not
/// touched costs nothing, so a header that lies about the size does no harm.
[[nodiscard]] inline Image reserved_image(int width, int height, int channels, bool linear) {
    Image image;
    image.width = width;
    image.height = height;
    image.channels = channels;
    image.linear = linear;
    image.samples.reserve(std::size_t(width) * std::size_t(height) * std::size_t(channels));
    return image;
}

}  // namespace alhazen
