#pragma once
/// Checks the sizes in an OpenEXR header before the library reads the file.
///
/// Source: "OpenEXR File Layout", openexr.com.
/// Differs: reads only the attributes that decoding needs. The limits of the picture's size apply
/// to the display window and, as the library's memory grows with it, to the data window.
/// Conventions: the first part of a multi-part file is decoded; the others are checked too, because
/// the library prepares all of them.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen {

/// The corners of a window, inclusive.
struct ExrWindow {
    std::int64_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;
    [[nodiscard]] std::int64_t width() const { return x1 - x0 + 1; }
    [[nodiscard]] std::int64_t height() const { return y1 - y0 + 1; }
};

struct ExrPart {
    ExrWindow display;  ///< the data window if the file states none
    /// Upper bound of the library's allocations for decoding it: a run of rows or a tile (packed,
    /// unpacked and being unpacked), and a row of tiles.
    std::uint64_t decoder_bytes = 0;
    bool deep = false;  ///< has any number of samples per pixel; not decoded
};

struct ExrHeader {
    std::string bytes;
    std::vector<ExrPart> parts;  ///< at least one
};

/// The start of the file up to the end of the header. Attributes that decoding does not need get an
/// unknown type: the library would allocate by lengths stored inside some of them. Throws Error:
/// Scene if the header is malformed or all parts are deep, Resource if a size exceeds the limits.
[[nodiscard]] ExrHeader checked_exr_header(std::string_view bytes, const std::string& name,
                                           const ImageLimits& limits);

}  // namespace alhazen
