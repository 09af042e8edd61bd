#include "alhazen/session/picture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/base/lower_case.h"
#include "alhazen/imaging/codecs/exr_layers.h"
#include "alhazen/imaging/codecs/half_range.h"
#include "alhazen/imaging/codecs/jpeg.h"
#include "alhazen/imaging/codecs/png.h"

namespace alhazen {

bool holds_layers(const std::filesystem::path& path) {
    return lower_suffix(path) == ".exr";
}

namespace {

Encoding encoding_of(const FilmConventions& conventions, const PictureOptions& options) {
    const bool mapped = !options.tone.changes_nothing();
    return options.encoding.value_or(mapped ? Encoding::Srgb : conventions.encoding());
}

/// The codes of the crop for a display. Refers to `film`.
CodeRows picture_rows(const Film& film, const FilmConventions& conventions,
                      const PictureOptions& options) {
    const int width = film.crop().width();
    CodeRows rows{.width = width, .height = film.crop().height(), .bits = options.bits};
    const Encoding encoding = encoding_of(conventions, options);
    const auto row = [&film, width](int y) {
        return film.data() + std::size_t{3} * std::size_t(y) * std::size_t(width);
    };
    if (options.tone.changes_nothing()) {
        rows.fill = [=, bits = options.bits](int y, std::span<std::uint16_t> codes) {
            encode(row(y), encoding, bits, codes);
        };
        return rows;
    }
    rows.fill = [=, map = ToneMapper(options.tone), bits = options.bits](
                    int y, std::span<std::uint16_t> codes) {
        constexpr std::size_t kAtOnce = 3 * 128;
        std::array<double, kAtOnce> mapped;
        const double* from = row(y);
        while (!codes.empty()) {
            const std::size_t count = std::min(codes.size(), kAtOnce);
            for (std::size_t i = 0; i < count; i += 3) {
                const Rgb shown = map({from[i], from[i + 1], from[i + 2]});
                mapped[i] = shown.r, mapped[i + 1] = shown.g, mapped[i + 2] = shown.b;
            }
            encode(mapped.data(), encoding, bits, codes.first(count));
            codes = codes.subspan(count);
            from += count;
        }
    };
    return rows;
}

/// The bytes of the file with this suffix.
std::vector<std::byte> picture_bytes(const std::string& suffix, const Film& film,
                                     const FilmConventions& conventions,
                                     const PictureOptions& options) {
    if (suffix == ".png") {
        return encode_png(picture_rows(film, conventions, options), options.metadata);
    }
    if (suffix == ".jpg" || suffix == ".jpeg") {
        PictureOptions eight = options;
        eight.bits = 8;
        return encode_jpeg(encoded_picture(film, conventions, eight),
                           ImageWriteOptions{}.jpeg_quality);
    }
    if (suffix == ".exr" && options.layers != nullptr) {
        return encode_exr_layers(film, *options.layers,
                                 {.full_float = options.full_float, .metadata = options.metadata});
    }
    const PixelBox& crop = film.crop();
    ImageWriteOptions write;
    write.full_float = options.full_float;
    write.metadata = options.metadata;
    write.full_width = film.frame_width();
    write.full_height = film.frame_height();
    write.crop_x0 = crop.x0;
    write.crop_y0 = crop.y0;
    return encode_image(suffix.substr(1), film.to_image(), write);
}

}  // namespace

EncodedImage encoded_picture(const Film& film, const FilmConventions& conventions,
                             const PictureOptions& options) {
    const CodeRows rows = picture_rows(film, conventions, options);
    const std::size_t row_codes = std::size_t{3} * std::size_t(rows.width);
    EncodedImage codes{.width = rows.width, .height = rows.height, .bits = rows.bits};
    codes.samples.resize(row_codes * std::size_t(rows.height));
    for (int y = 0; y < rows.height; ++y) {
        rows.fill(y, {codes.samples.data() + std::size_t(y) * row_codes, row_codes});
    }
    return codes;
}

BeyondHalf beyond_half(const Film& film, const FilmLayers* layers) {
    BeyondHalf result;
    const std::size_t pixels = film.crop().area();
    const double* const from = film.data();
    // As the codec is given them: beyond float they are infinite.
    const auto is_beyond = [&](std::size_t k) {
        return is_beyond_half(static_cast<float>(from[k]));
    };
    for (std::size_t i = 0; i < pixels; ++i) {
        result.colors += is_beyond(3 * i) || is_beyond(3 * i + 1) || is_beyond(3 * i + 2);
    }
    if (layers == nullptr) return result;
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto& channels = layers->channels();
        result.layers += std::any_of(channels.begin(), channels.end(), [&](const auto& channel) {
            return channel.type == SampleType::Half && is_beyond_half(channel.values[i]);
        });
    }
    return result;
}

void write_picture(const std::filesystem::path& path, const Film& film,
                   const FilmConventions& conventions, const PictureOptions& options) {
    check_image_suffix(path);
    write_file_atomically(path, picture_bytes(lower_suffix(path), film, conventions, options),
                          options.sync);
}

}  // namespace alhazen
