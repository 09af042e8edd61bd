#pragma once
/// Nearest-point queries.

#include <pybind11/numpy.h>

#include "built_scene.h"

namespace alhazen::python {

/// The nearest points of meshes and shapes to points (..., 3): distance, points, geometry_ids,
/// primitive_ids, uvs, normals. Throws Error as PlacedSurfaces.
[[nodiscard]] pybind11::dict closest_points(const BuiltScene& scene, const pybind11::object& points,
                                            int threads);

}  // namespace alhazen::python
