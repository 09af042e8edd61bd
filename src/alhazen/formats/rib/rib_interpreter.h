#pragma once
/// Carries out the requests of a RIB file: transforms, attributes, the camera, geometry.
///
/// Source: Pixar, "The RenderMan Interface", version 3.2, 2000.
/// Differs: of several worlds the first is read, of a motion block the first request. Shaders,
/// lights and all other requests are ignored, with one warning that lists them.
/// Conventions: the world is the scene's frame; the transform at WorldBegin makes the camera, which
/// looks along z with x to the right and y up.

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// Adds what the file describes to `scene`, which has its root. Throws Error (Resource).
void interpret_rib(const ImportSource& source, SceneDescription& scene, Diagnostics& diagnostics);

}  // namespace alhazen
