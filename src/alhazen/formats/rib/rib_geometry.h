#pragma once
/// The geometry requests of RIB: Patch, PatchMesh, NuPatch, TrimCurve and whole quadrics.
///
/// Source: Pixar, "The RenderMan Interface", version 3.2, 2000, sections 5.3 to 5.5.
/// Differs: quadrics limited by zmin, zmax or thetamax are omitted; the caller warns of them.
/// Conventions: u varies fastest in a request; surfaces here are u-major.

#include "alhazen/formats/rib/rib_scene.h"

namespace alhazen {

/// Reads a geometry request into `scene`, or reports its errors. False if it is none of those
/// above, or a part of a quadric.
bool read_rib_geometry(const RibRequest& request, const RibState& state, RibScene& scene);

/// Reads `TrimCurve ncurves order knot min max n u v w`. Null after an error and if there are no
/// loops.
[[nodiscard]] std::shared_ptr<const std::vector<TrimLoop>> read_rib_trims(const RibRequest& request,
                                                                          RibScene& scene);

}  // namespace alhazen
