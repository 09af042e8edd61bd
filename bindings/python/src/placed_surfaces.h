#pragma once
/// All placed triangles and shapes of a scene, for nearest-point queries.
///
/// Conventions: those of nearest_triangles.h and exact_surface.h, in world space. The contents of
/// instances are copied for each placement. Ids are those of the hits of a Tracer.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "alhazen/geometry/nearest/nearest_boxes.h"
#include "alhazen/geometry/nearest/nearest_triangles.h"
#include "alhazen/geometry/placement.h"
#include "alhazen/scene_model/scene_description.h"
#include "alhazen/shapes/exact_surface.h"
#include "alhazen/tracer/tracer.h"

namespace alhazen::python {

class PlacedSurfaces {
  public:
    /// Limit for scenes with instances. A triangle takes `kTriangleBytes` including its part of the
    /// tree; a shape takes its data if it is stretched (ExactSurface::bytes).
    static constexpr double kTriangleBytes = 164;
    static constexpr double kMostBytes = kTriangleBytes * (1 << 25);

    /// Throws Error: Usage if there are CSG solids, or shapes without nearest-point queries
    /// (exact_surface.h), naming the first one; Resource beyond the limit. Can be interrupted.
    PlacedSurfaces(const Tracer& tracer, const SceneDescription& description);

    struct Found : NearestTriangle {
        std::uint32_t geometry = kNone, primitive = kNone;  ///< primitive 0 for a shape
        Vec3 normal;                                        ///< unit, as for a hit; 0 if undefined
    };
    [[nodiscard]] Found nearest(const Vec3& point) const;

  private:
    /// A mesh in one place; its triangles are consecutive.
    struct Run {
        std::uint32_t first = 0, geometry = 0;
        const PlacedMesh* mesh = nullptr;
        bool placed = false;  ///< inside an instance
        Placement world;
    };
    struct PlacedShape {
        ExactSurface surface;
        std::uint32_t geometry = 0;
    };
    class Collector;

    explicit PlacedSurfaces(Collector collector);
    /// Sets ids and normal of a triangle that was found.
    void name(Found& found) const;
    void take_nearer_shape(const Vec3& point, Found& found) const;

    std::vector<Run> runs_;  ///< sorted by `first`
    std::vector<PlacedShape> shapes_;
    NearestTriangles tree_;
    NearestBoxes shape_tree_;
};

}  // namespace alhazen::python
