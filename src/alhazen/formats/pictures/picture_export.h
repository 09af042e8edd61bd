#pragma once
/// Textures as bytes of image files that read back to the same samples.

#include <cstddef>
#include <string>
#include <vector>

#include "alhazen/imaging/codecs/stored_image.h"

namespace alhazen {

struct PictureFile {
    std::string suffix;  ///< "png" for 8-bit and 16-bit codes, "exr" for floats
    std::vector<std::byte> bytes;
};

[[nodiscard]] PictureFile picture_file(const StoredImage& image);

}  // namespace alhazen
