#pragma once
/// Lights of a scene: regions with the shader `light`.
///
/// Source: BRL-CAD, manual page of `rt` on the shader `light`.
/// Differs: a light is a point in the centre of its region's box, isotropic and without falloff;
/// an infinite one is directional. The lights share 5 / 6 of full light in proportion to their
/// fractions.
/// Conventions: without light regions no lights are added; the scene is shown with a light at the
/// eye.

#include "alhazen/formats/brlcad/brlcad_bounds.h"
#include "alhazen/formats/brlcad/brlcad_materials.h"

namespace alhazen {

/// Adds the lights of the regions of the root, and their ambient light. More than a thousand are
/// an error.
void add_brlcad_lights(SceneDescription& scene, const BrlcadMaterials& materials,
                       BrlcadBounds& bounds, Diagnostics& diagnostics);

}  // namespace alhazen
