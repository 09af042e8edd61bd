#include "surface_queries.h"

#include <cmath>

#include "array_making.h"
#include "interruptible.h"
#include "ray_array.h"

namespace py = pybind11;

namespace alhazen::python {

namespace {

/// Builds the structure on first use; Ctrl-C ends the build.
const PlacedSurfaces& built(const BuiltScene& scene) {
    if (const PlacedSurfaces* made = scene.made_nearest()) return *made;
    run_interruptible([&] { static_cast<void>(scene.nearest()); });
    return scene.nearest();
}

}  // namespace

py::dict closest_points(const BuiltScene& scene, const py::object& points_object, int threads) {
    const NumberArray points(points_object, {3}, "points");
    const PlacedSurfaces& triangles = built(scene);
    const RealArray distance(points.single(), points.shape(), 0);
    const RealArray nearest(points.single(), points.shape(), 3);
    const RealArray uvs(points.single(), points.shape(), 2);
    const RealArray normals(points.single(), points.shape(), 3);
    const PlainArray<std::uint32_t> geometry(points.shape()), primitive(points.shape());
    run_in_blocks(points.count(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 from = points.vector(i, 0);
            const PlacedSurfaces::Found found = triangles.nearest(from);
            // The distance of a non-finite point is NaN.
            distance.set(i, is_finite(from) ? std::sqrt(found.squared)
                                            : std::numeric_limits<double>::quiet_NaN());
            nearest.set(i, found.point);
            uvs.set(2 * i, found.u);
            uvs.set(2 * i + 1, found.v);
            geometry[i] = found.geometry;
            primitive[i] = found.primitive;
            normals.set(i, found.normal);
        }
    });
    py::dict result;
    result["distance"] = distance.array();
    result["points"] = nearest.array();
    result["geometry_ids"] = geometry.array();
    result["primitive_ids"] = primitive.array();
    result["uvs"] = uvs.array();
    result["normals"] = normals.array();
    return result;
}

}  // namespace alhazen::python
