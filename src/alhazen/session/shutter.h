#pragma once
/// Motion blur: scenes over the time that a shutter is open.

#include <filesystem>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// Opens the shutter of the scene. An animated format is read at several times while the shutter is
/// open; parts, vertices of meshes and cameras that differ then move. Times are in seconds for such
/// formats, otherwise in the unit of the file's keys. Warns if nothing moves, and if a light moves.
/// Throws Error (Scene) if the contents of the file differ between times.
void open_shutter_of(SceneDescription& description, const ImportOptions& options,
                     const Shutter& shutter, Diagnostics& diagnostics);

}  // namespace alhazen
