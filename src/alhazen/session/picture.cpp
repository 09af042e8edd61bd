#include "alhazen/session/picture.h"

#include "alhazen/base/lower_case.h"
#include "alhazen/imaging/codecs/exr_layers.h"

namespace alhazen {

bool holds_layers(const std::filesystem::path& path) {
    return lower_suffix(path) == ".exr";
}

void write_picture(const std::filesystem::path& path, const Film& film,
                   const FilmConventions& conventions, const PictureOptions& options) {
    check_image_suffix(path);
    const Encoding encoding = options.encoding.value_or(conventions.encoding());
    const std::string suffix = lower_suffix(path);
    const PixelBox& crop = film.crop();
    if (suffix == ".png") {
        write_png(path, encode(film.data(), crop.width(), crop.height(), encoding, options.bits),
                  options.metadata);
    } else if (suffix == ".jpg" || suffix == ".jpeg") {
        write_jpeg(path, encode(film.data(), crop.width(), crop.height(), encoding, 8));
    } else if (options.layers != nullptr && holds_layers(path)) {
        write_exr_layers(path, film, *options.layers,
                         {.full_float = options.full_float, .metadata = options.metadata});
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
