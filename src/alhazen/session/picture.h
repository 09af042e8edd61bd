#pragma once
/// Writes a film to a picture file.

#include <cstddef>
#include <filesystem>
#include <optional>

#include "alhazen/base/file.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/imaging/film/film_layers.h"
#include "alhazen/imaging/image/tone_mapping.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

struct PictureOptions {
    std::optional<Encoding> encoding;  ///< default: the format's
    int bits = 8;
    bool full_float = false;
    ImageMetadata metadata;
    const FilmLayers* layers = nullptr;  ///< written with the colours to files with suffix .exr
    ToneMapping tone;                    ///< for PNG and JPEG; the default encoding is then sRGB
    Sync sync = Sync::ToDisk;
};

/// True if the format holds layers (EXR only).
[[nodiscard]] bool holds_layers(const std::filesystem::path& path);

/// The codes of the film in a picture of `options.bits` per channel.
[[nodiscard]] EncodedImage encoded_picture(const Film& film, const FilmConventions& conventions,
                                           const PictureOptions& options);

/// Pixels with finite numbers beyond the range of half, which an EXR clamps.
struct BeyondHalf {
    std::size_t colors = 0;  ///< in the film; clamped unless `full_float`
    std::size_t layers = 0;  ///< in some layer of type half
};
[[nodiscard]] BeyondHalf beyond_half(const Film& film, const FilmLayers* layers);

/// Writes the film in one step. Integer formats are encoded from the film's doubles: truncation is
/// exact. Throws Error.
void write_picture(const std::filesystem::path& path, const Film& film,
                   const FilmConventions& conventions, const PictureOptions& options);

}  // namespace alhazen
