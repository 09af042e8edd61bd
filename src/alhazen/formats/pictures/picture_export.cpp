#include "alhazen/formats/pictures/picture_export.h"

#include <variant>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/codecs/png.h"

namespace alhazen {

namespace {

template <class Code>
PictureFile codes_file(const StoredImage& image, const std::vector<Code>& codes) {
    const EncodedImage encoded{.width = image.width,
                               .height = image.height,
                               .channels = image.channels,
                               .bits = static_cast<int>(8 * sizeof(Code)),
                               .samples = {codes.begin(), codes.end()}};
    return {"png", encode_png(encoded, {})};
}

}  // namespace

PictureFile picture_file(const StoredImage& image) {
    if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&image.samples)) {
        return codes_file(image, *bytes);
    }
    if (const auto* shorts = std::get_if<std::vector<std::uint16_t>>(&image.samples)) {
        return codes_file(image, *shorts);
    }
    Image floats = expanded(image);
    floats.linear = true;  // prevents the writer from removing the sRGB curve
    return {"exr", encode_image("exr", floats, {.full_float = true})};
}

}  // namespace alhazen
