#pragma once
/// A picture with all its layers as one OpenEXR file, for compositing programs.
///
/// Source: F. Kainz, R. Bogart, "Technical Introduction to OpenEXR", 2009, "Channel Names" (layers
/// are prefixes of channel names).
/// Differs: nothing. One part; scan lines, ZIP-compressed.
/// Conventions: the beauty is R, G, B, linear; layers keep the names and types of their channels.
/// The data window is the film's crop, the display window its frame. The same numbers give the same
/// bytes.

#include <cstddef>
#include <vector>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/imaging/film/film_layers.h"

namespace alhazen {

struct ExrLayersOptions {
    bool full_float = false;  ///< R, G, B in float instead of half
    ImageMetadata metadata = {};
};

/// Throws Error (Usage) when the layers have another crop than the film, a channel has no name or
/// that of another, or a metadata key is empty or longer than 255.
[[nodiscard]] std::vector<std::byte> encode_exr_layers(const Film& film, const FilmLayers& layers,
                                                       const ExrLayersOptions& options);

/// The same to a file, as one step.
void write_exr_layers(const std::filesystem::path& path, const Film& film, const FilmLayers& layers,
                      const ExrLayersOptions& options);

}  // namespace alhazen
