#include "alhazen/session/picture.h"

#include "alhazen/base/lower_case.h"
#include "alhazen/imaging/codecs/exr_layers.h"

namespace alhazen {

bool holds_layers(const std::filesystem::path& path) {
    return lower_suffix(path) == ".exr";
}

namespace {

/// The pixels of the crop as a display shall show them.
Film tone_mapped(const Film& film, const ToneMapping& tone) {
    Film shown = film;
    const ToneMapper map(tone);
    const PixelBox& crop = film.crop();
    for (int y = crop.y0; y < crop.y1; ++y) {
        for (int x = crop.x0; x < crop.x1; ++x) shown.set(x, y, map(film.at(x, y)));
    }
    return shown;
}

}  // namespace

EncodedImage encoded_picture(const Film& film, const FilmConventions& conventions,
                             const PictureOptions& options) {
    const int width = film.crop().width(), height = film.crop().height();
    if (options.tone.changes_nothing()) {
        const Encoding encoding = options.encoding.value_or(conventions.encoding());
        return encode(film.data(), width, height, encoding, options.bits);
    }
    return encode(tone_mapped(film, options.tone).data(), width, height,
                  options.encoding.value_or(Encoding::Srgb), options.bits);
}

void write_picture(const std::filesystem::path& path, const Film& film,
                   const FilmConventions& conventions, const PictureOptions& options) {
    check_image_suffix(path);
    const std::string suffix = lower_suffix(path);
    const PixelBox& crop = film.crop();
    if (suffix == ".png") {
        write_png(path, encoded_picture(film, conventions, options), options.metadata);
    } else if (suffix == ".jpg" || suffix == ".jpeg") {
        PictureOptions eight = options;
        eight.bits = 8;
        write_jpeg(path, encoded_picture(film, conventions, eight));
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
