#pragma once
/// Executes the requests of a RIB file: transforms, attributes, the camera, geometry.
///
/// Source: Pixar, "The RenderMan Interface", version 3.2, 2000.
/// Differs: reads only the first world, and the first request of a motion block. Shaders, lights
/// and all other requests are ignored, with one warning that lists them.
/// Conventions: the world is the scene's frame; the transform at WorldBegin defines the camera,
/// which looks along z with x to the right and y up.

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// Adds the contents of the file to `scene`, which must have its root. Throws Error (Resource).
void interpret_rib(const ImportSource& source, SceneDescription& scene, Diagnostics& diagnostics);

}  // namespace alhazen
