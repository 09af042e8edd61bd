#pragma once
/// Batches of rays from numpy arrays (docs/guide/python.md).
///
/// Conventions: results are dicts of arrays in the shape of the rays. Without a hit t_hit is
/// infinite, ids are 0xFFFFFFFF, and all other values are 0.

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "built_scene.h"

namespace alhazen::python {

struct BatchOptions {
    RayMask mask = kAllRays;
    bool coherent = false;
    int threads = 0;
};

/// The nearest hits; `fields` selects the arrays. Throws Error (Usage) for an unknown field.
[[nodiscard]] pybind11::dict intersect(const BuiltScene& scene, const pybind11::object& rays,
                                       const std::vector<std::string>& fields,
                                       const BatchOptions& options);
/// All fields of `intersect`, in order.
[[nodiscard]] std::vector<std::string> hit_fields();
[[nodiscard]] pybind11::object occluded(const BuiltScene& scene, const pybind11::object& rays,
                                        const BatchOptions& options);
/// Hits of ray i in C order are [ray_splits[i], ray_splits[i + 1]) of the other arrays.
[[nodiscard]] pybind11::dict all_hits(const BuiltScene& scene, const pybind11::object& rays,
                                      const BatchOptions& options);
[[nodiscard]] pybind11::object count_intersections(const BuiltScene& scene,
                                                   const pybind11::object& rays,
                                                   const BatchOptions& options);
/// True if `intersect` and `occluded` read the rays in place.
[[nodiscard]] bool traced_in_place(const pybind11::object& rays);

}  // namespace alhazen::python
