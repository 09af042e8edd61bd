#pragma once
/// A look at the sizes in an OpenEXR header before the library is let at the file.
///
/// Source: "OpenEXR File Layout", openexr.com.
/// Differs: only the attributes that decoding needs are read.
/// Conventions: the first part of a multi-part file is the one that is decoded; the others are
/// checked too, because the library prepares all of them.

#include <cstdint>
#include <string>
#include <string_view>

#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen {

struct ExrHeader {
    std::string bytes;
    /// What the library allocates at most to decode the first part: a run of rows or a tile as
    /// packed, unpacked and while it is unpacked, and a row of tiles.
    std::uint64_t decoder_bytes = 0;
};

/// The start of the file up to the end of the header, in which the attributes that decoding does
/// not need have an unknown type: the library would allocate by lengths that stand inside some of
/// them. Throws Error: Scene when the header is malformed or of deep data, Resource when a size
/// exceeds the limits.
[[nodiscard]] ExrHeader checked_exr_header(std::string_view bytes, const std::string& name,
                                           const ImageLimits& limits);

}  // namespace alhazen
