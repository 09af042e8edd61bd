#pragma once
/// Corners of the faces of solids with planar faces.

#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/shapes/polygons/box_shape.h"
#include "alhazen/shapes/polygons/polyhedron.h"

namespace alhazen {

struct FaceLoop {
    std::uint32_t face = 0;     ///< as in `part` of a hit
    Vec3 normal{};              ///< unit, outward
    std::vector<Vec3> corners;  ///< counterclockwise seen from outside
};

[[nodiscard]] std::vector<FaceLoop> face_loops(const BoxShape& box);
/// Faces without corners are left out; nothing for an unbounded polyhedron.
[[nodiscard]] std::optional<std::vector<FaceLoop>> face_loops(const Polyhedron& solid);
/// The same with corners that differ by rounding made one, so that each edge belongs to two faces;
/// nothing if some does not, as with corners of nearly parallel planes.
[[nodiscard]] std::optional<std::vector<FaceLoop>> closed_face_loops(const Polyhedron& solid);

}  // namespace alhazen
