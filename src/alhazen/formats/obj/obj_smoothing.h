#pragma once
/// Normals for OBJ corners without normals.
///
/// Source: "Object Files (.obj)", Wavefront, 1992: smoothing groups (`s`).
/// Differs: the manual specifies no weights; faces are weighted by area.

#include <string>
#include <vector>

#include "alhazen/formats/obj/obj_statements.h"

namespace alhazen {

/// Assigns each corner without a normal in a smoothing group the sum of the area-weighted normals
/// of the group's faces around its position, not normalised. Precondition: indices are in range.
/// Throws Error (Resource) if the normals exceed the index range.
void smooth_obj_normals(ObjStatements& statements, const std::string& file);

/// Assigns the corners without a normal in the runs marked by `wanted` the normal of their face,
/// not normalised. Precondition and errors as above.
void flatten_obj_normals(ObjStatements& statements, const std::string& file,
                         const std::vector<bool>& wanted);

}  // namespace alhazen
