#pragma once
/// Checks of image sizes and memory, and errors for malformed images, shared by all readers.

#include <cstdint>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen {

/// Throws Error (Scene) for a malformed image.
[[noreturn]] inline void bad_image(const std::string& name, const std::string& what) {
    throw Error(ErrorKind::Scene, what, {name, 0, 0});
}

/// Throws Error: Scene for an empty image, Resource for one beyond the limits.
inline void check_image_size(std::int64_t width, std::int64_t height, const ImageLimits& limits,
                             const std::string& name) {
    const auto size = [&] { return std::to_string(width) + " x " + std::to_string(height); };
    if (width <= 0 || height <= 0) bad_image(name, "the picture is empty (" + size() + " pixels)");
    const auto refuse = [&](const std::string& allowed) {
        throw Error(ErrorKind::Resource,
                    "the picture is too large: " + size() + " pixels, allowed are " + allowed,
                    {name, 0, 0});
    };
    if (width > limits.max_side || height > limits.max_side) {
        refuse("sides of " + std::to_string(limits.max_side) + " (--max-image-side)");
    }
    if (std::uint64_t(width) * std::uint64_t(height) > limits.max_pixels) {
        refuse(std::to_string(limits.max_pixels) + " pixels (--max-image-pixels)");
    }
}

/// Throws ImageMemoryExceeded if `bytes` exceed the limit. Call it before allocation, with all
/// bytes that will be in memory at the same time.
inline void check_image_memory(std::uint64_t bytes, const ImageLimits& limits,
                               const std::string& name) {
    if (bytes <= limits.max_bytes) return;
    constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
    throw ImageMemoryExceeded(
        ErrorKind::Resource,
        "the picture is too large: reading it takes " + std::to_string((bytes + kMiB - 1) / kMiB) +
            " MiB, " + std::to_string(limits.max_bytes / kMiB) + " MiB are left (--max-image-mib)",
        {name, 0, 0});
}

/// The bytes of the samples of an image of a checked size.
[[nodiscard]] inline std::uint64_t sample_bytes(std::int64_t width, std::int64_t height,
                                                std::uint64_t channels, std::size_t each) {
    return std::uint64_t(width) * std::uint64_t(height) * channels * each;
}

/// An image of a checked size, to which rows are then appended. Reserved memory that is not touched
/// costs nothing, so a header with a false size is harmless. Throws as check_image_memory.
[[nodiscard]] inline Image reserved_image(int width, int height, int channels, bool linear,
                                          const ImageLimits& limits, const std::string& name) {
    check_image_memory(sample_bytes(width, height, std::uint64_t(channels), sizeof(float)), limits,
                       name);
    Image image;
    image.width = width;
    image.height = height;
    image.channels = channels;
    image.linear = linear;
    image.samples.reserve(std::size_t(width) * std::size_t(height) * std::size_t(channels));
    return image;
}

}  // namespace alhazen
