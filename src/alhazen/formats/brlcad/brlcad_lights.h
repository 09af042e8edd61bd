#pragma once
/// The lights of a scene: regions whose shader is `light`.
///
/// Source: BRL-CAD, manual page of `rt` on the shader `light`. Differs: a light shines from the
/// middle of its box, equally in all directions, and does not grow weaker with distance; all share
/// 5 / 6 of full light by their fractions. Conventions: without such regions there is none, and the
/// scene is shown with a light at the eye.

#include "alhazen/formats/brlcad/brlcad_bounds.h"
#include "alhazen/formats/brlcad/brlcad_materials.h"

namespace alhazen {

/// Adds the lights of the regions that the root shows, and the ambient light that comes with them.
/// More than a thousand are an error.
void add_brlcad_lights(SceneDescription& scene, const BrlcadMaterials& materials,
                       BrlcadBounds& bounds, Diagnostics& diagnostics);

}  // namespace alhazen
