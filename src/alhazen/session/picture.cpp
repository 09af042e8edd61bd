#include "alhazen/session/picture.h"

#include <algorithm>
#include <cctype>

namespace alhazen {

void write_picture(const std::filesystem::path& path, const Film& film,
                   const ShadingConventions& conventions, const PictureOptions& options) {
    check_image_suffix(path);
    const Encoding encoding = options.encoding.value_or(
        conventions.linear_output ? Encoding::LinearTruncated : Encoding::Srgb);
    std::string suffix = path.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const PixelBox& crop = film.crop();
    if (suffix == ".png") {
        write_png(path, encode(film.data(), crop.width(), crop.height(), encoding, options.bits),
                  options.metadata);
    } else if (suffix == ".jpg" || suffix == ".jpeg") {
        write_jpeg(path, encode(film.data(), crop.width(), crop.height(), encoding, 8));
    } else {
        ImageWriteOptions write;
        write.full_float = options.full_float;
        write.metadata = options.metadata;
        write.full_width = film.frame_width();
        write.full_height = film.frame_height();
        write.crop_x0 = crop.x0;
        write.crop_y0 = crop.y0;
        write_image(path, film.to_image(), write);
    }
}

}  // namespace alhazen
