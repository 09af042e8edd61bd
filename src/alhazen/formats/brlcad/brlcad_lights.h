#pragma once
/// Lights of a scene: regions with the shader `light`.
///
/// Source: BRL-CAD, manual page of `rt` on the shader `light`.
/// Differs: a light is a point in the centre of its region's box, without falloff; an infinite one
/// is directional. One with an angle shines into a cone, and is seen bright from everywhere.
/// Conventions: the brightest light without a fraction of its own has 5 / 6 of full light, others
/// by their intensity. A model without light regions has one beside the eye of the first camera and
/// no shadows, as `rt` makes it. The ambient light of 0.4 falls with the view.

#include "alhazen/formats/brlcad/brlcad_bounds.h"
#include "alhazen/formats/brlcad/brlcad_materials.h"

namespace alhazen {

/// Adds the lights of the regions of the root, and the ambient light. More than a thousand are an
/// error. Reads the first camera.
void add_brlcad_lights(SceneDescription& scene, const BrlcadMaterials& materials,
                       BrlcadBounds& bounds, Diagnostics& diagnostics);

}  // namespace alhazen
