#pragma once
/// Normals for the corners of an OBJ file that have none of their own.
///
/// Source: "Object Files (.obj)", Wavefront, 1992: smoothing groups (`s`).
/// Differs: the manual leaves the weights open; here a face counts by its area.

#include <string>
#include <vector>

#include "alhazen/formats/obj/obj_statements.h"

namespace alhazen {

/// Gives each corner without a normal that is in a smoothing group the sum of the area-weighted
/// normals of the group's faces around its position; not made unit.
/// Preconditions: indices are in range. Throws Error (Resource) when there would be too many.
void smooth_obj_normals(ObjStatements& statements, const std::string& file);

/// Gives the corners without a normal in the runs marked by `wanted` the normal of their face; not
/// made unit. Preconditions and errors as above.
void flatten_obj_normals(ObjStatements& statements, const std::string& file,
                         const std::vector<bool>& wanted);

}  // namespace alhazen
