#pragma once

#include <cstddef>

#include "alhazen/math/unit_vector.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// The unit normal of a triangle, on the side from which its vertices turn counterclockwise; the z
/// axis for one without area.
[[nodiscard]] inline Vec3 triangle_normal(const TriangleMesh& mesh, std::size_t triangle) {
    const auto& [i0, i1, i2] = mesh.triangles[triangle];
    const Vec3& p0 = mesh.positions[i0];
    return unit_or(accurate_cross(mesh.positions[i1] - p0, mesh.positions[i2] - p0), {0, 0, 1});
}

}  // namespace alhazen
