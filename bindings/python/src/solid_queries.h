#pragma once
/// Solids of a scene from Python: spans, containment, thickness, measures, sections.
///
/// Conventions: solids are numbered as in SolidList; results of rays have the shape of the rays.

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "built_scene.h"

namespace alhazen::python {

/// A dict of ray_splits, ray_ids, solid_ids, t_enter, t_exit.
[[nodiscard]] pybind11::dict spans(const BuiltScene& scene, const pybind11::object& rays,
                                   int threads);
/// Lengths of the rays inside any solid, in scene units.
[[nodiscard]] pybind11::object thickness(const BuiltScene& scene, const pybind11::object& rays,
                                         int threads);
/// Tests whether the points (..., 3) are in any solid.
[[nodiscard]] pybind11::object inside(const BuiltScene& scene, const pybind11::object& points,
                                      int threads);
/// A dict of point_splits, point_ids, solid_ids, on_surface.
[[nodiscard]] pybind11::dict solids_at(const BuiltScene& scene, const pybind11::object& points,
                                       int threads);

[[nodiscard]] std::vector<std::string> solid_names(const BuiltScene& scene);

/// The report of `alhazen measure` as JSON for the solids that `words` select; all if it is empty.
[[nodiscard]] std::string measure_json(const BuiltScene& scene,
                                       const std::vector<std::string>& words, double error,
                                       double seconds, std::uint64_t seed, int threads);

/// A list of dicts, one for each solid that the plane cuts.
[[nodiscard]] pybind11::list section(const BuiltScene& scene, const Vec3& normal, double offset,
                                     const std::vector<std::string>& words, double tolerance,
                                     int cells, int threads);

}  // namespace alhazen::python
