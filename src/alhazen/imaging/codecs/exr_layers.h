#pragma once
/// Writes an image with all its layers as one OpenEXR file, for compositing programs.
///
/// Source: F. Kainz, R. Bogart, "Technical Introduction to OpenEXR", 2009, "Channel Names" (layers
/// are prefixes of channel names).
/// Conventions: one part; scan lines, ZIP-compressed. The beauty image is R, G, B, linear; layers
/// keep the names and types of their channels. Numbers beyond the range of half become the largest
/// half (half_range.h). The data window is the film's crop, the display
/// window its frame. The same numbers give the same bytes.

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

/// The bytes of the file. Throws Error (Usage) if the layers have another crop than the film, a
/// channel has no name or a name already used, or a metadata key is empty or longer than 255.
[[nodiscard]] std::vector<std::byte> encode_exr_layers(const Film& film, const FilmLayers& layers,
                                                       const ExrLayersOptions& options);

}  // namespace alhazen
