#pragma once
/// Textures as the bytes of picture files that read back to the same samples.

#include <cstddef>
#include <string>
#include <vector>

#include "alhazen/imaging/codecs/stored_image.h"

namespace alhazen {

struct PictureFile {
    std::string suffix;  ///< "png" for codes of 8 or 16 bits, "exr" for floats
    std::vector<std::byte> bytes;
};

[[nodiscard]] PictureFile picture_file(const StoredImage& image);

}  // namespace alhazen
