#pragma once
/// Scenes over the time that a shutter is open.

#include <filesystem>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// Opens the shutter of the scene. A scene of a format with animations is read at several times
/// while the shutter is open, and what differs moves: parts, vertices of meshes, cameras. Times
/// are in seconds there, else in the unit of the file's keys. Warns where nothing moves, and where
/// a light does. Throws Error (Scene) where the file has other things at another time.
void open_shutter_of(SceneDescription& description, const ImportOptions& options,
                     const Shutter& shutter, Diagnostics& diagnostics);

}  // namespace alhazen
