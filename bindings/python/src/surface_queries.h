#pragma once
/// Questions about points and the surfaces near them.

#include <pybind11/numpy.h>

#include "built_scene.h"

namespace alhazen::python {

/// The nearest points of the triangles to points (..., 3): distance, points, geometry_ids,
/// primitive_ids, uvs, normals. Throws Error (Usage) where the scene has other things than meshes.
[[nodiscard]] pybind11::dict closest_points(const BuiltScene& scene, const pybind11::object& points,
                                            int threads);

}  // namespace alhazen::python
