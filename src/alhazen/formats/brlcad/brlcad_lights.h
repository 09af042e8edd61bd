#pragma once
/// Lights of a scene: regions with the shader `light`.
///
/// Source: BRL-CAD, manual page of `rt` on the shader `light`.
/// Differs: a light is a point light in the centre of its region's box, without falloff; an
/// infinite one is directional. A light with an angle is a spot light, and its region appears
/// bright from all sides.
/// Conventions: without a fraction of their own, lights are proportional to their intensity, the
/// brightest with 5 / 6 of full light. A model without light regions gets one light beside the eye
/// of the first camera and no shadows, as in `rt`. The ambient light of 0.4 depends on the view
/// direction.

#include "alhazen/formats/brlcad/brlcad_bounds.h"
#include "alhazen/formats/brlcad/brlcad_materials.h"

namespace alhazen {

/// Adds the lights of the regions below the root, and the ambient light. More than a thousand
/// lights are an error. Reads the first camera.
void add_brlcad_lights(SceneDescription& scene, const BrlcadMaterials& materials,
                       BrlcadBounds& bounds, Diagnostics& diagnostics);

}  // namespace alhazen
