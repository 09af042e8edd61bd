#pragma once
/// Makes shapes of the free-form surfaces of an OBJ file.
///
/// Source: "Object Files (.obj)", Wavefront, 1992; Piegl and Tiller, "The NURBS Book", 2nd ed.,
/// 1997, section 5.2 (knot insertion, for parts of trimming curves).
/// Conventions: Bezier and cardinal surfaces without trimming loops become patch meshes, one for
/// each object or group, material and pair of degrees, with shared control points; all others
/// become NURBS surfaces. Without `rat` weights are 1. The part inside the trim loops and outside
/// the holes is kept.

#include <string>
#include <vector>

#include "alhazen/formats/obj/obj_statements.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

struct ObjSurface {
    std::uint32_t name = 0, material = 0;  ///< index in the statements
    AnyShape shape;
    FileLocation location;
};

/// Makes the surfaces. Adds findings to `diagnostics`, at most 50 errors.
[[nodiscard]] std::vector<ObjSurface> make_obj_surfaces(const ObjStatements& statements,
                                                        const std::string& file,
                                                        Diagnostics& diagnostics);

}  // namespace alhazen
