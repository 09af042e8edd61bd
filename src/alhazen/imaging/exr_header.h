#pragma once
/// A look at the sizes in an OpenEXR header before the library is let at the file.
///
/// Source: "OpenEXR File Layout", openexr.com.
/// Differs: only the attributes that decide about memory are read (dataWindow, channels, tiles).
/// Conventions: the first part of a multi-part file is the one that is read; the others are checked
/// too, because the library prepares all of them.

#include <string>
#include <string_view>

#include "alhazen/imaging/image_io.h"

namespace alhazen {

/// Throws Error: Scene when the header is malformed or of deep data, Resource when a size exceeds
/// the limits.
void check_exr_header(std::string_view bytes, const std::string& name, const ImageLimits& limits);

}  // namespace alhazen
