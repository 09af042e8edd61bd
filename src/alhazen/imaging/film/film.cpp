#include "alhazen/imaging/film/film.h"

#include <fmt/format.h>

#include "alhazen/base/error.h"

namespace alhazen {

Film::Film(int frame_width, int frame_height, const PixelBox& crop)
    : frame_width_(frame_width), frame_height_(frame_height), crop_(crop) {
    if (crop.x0 < 0 || crop.y0 < 0 || crop.x1 > frame_width || crop.y1 > frame_height ||
        crop.x0 >= crop.x1 || crop.y0 >= crop.y1) {
        throw Error(ErrorKind::Usage,
                    fmt::format("crop {},{},{},{} is empty or leaves the {}x{} picture", crop.x0,
                                crop.y0, crop.x1, crop.y1, frame_width, frame_height));
    }
    samples_.resize(crop.area());
}

Image Film::to_image() const {
    Image image(crop_.width(), crop_.height(), 3);
    float* out = image.samples.data();
    for (const Rgb& c : samples_) {
        for (int i = 0; i < 3; ++i) *out++ = static_cast<float>(c[i]);
    }
    return image;
}

std::vector<PixelBox> tiles_of(const PixelBox& crop, int tile_size) {
    std::vector<PixelBox> tiles;
    for (int y = crop.y0; y < crop.y1; y += tile_size) {
        for (int x = crop.x0; x < crop.x1; x += tile_size) {
            tiles.push_back(
                {x, y, std::min(x + tile_size, crop.x1), std::min(y + tile_size, crop.y1)});
        }
    }
    return tiles;
}

}  // namespace alhazen
