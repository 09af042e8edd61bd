#pragma once
/// All triangles and shapes of a scene where they are placed, for questions about the nearest
/// point.
///
/// Conventions: those of nearest_triangles.h and exact_surface.h, in world space. What instances
/// hold is copied once for each place. Ids are those of the hits of a Tracer.

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
    /// More are refused where there are instances. A triangle takes `kTriangleBytes` with its part
    /// of the tree; a shape what it keeps where it is stretched (ExactSurface::bytes).
    static constexpr double kTriangleBytes = 164;
    static constexpr double kMostBytes = kTriangleBytes * (1 << 25);

    /// Throws Error: Usage where there are solids made of others, or shapes whose nearest points
    /// are not known (exact_surface.h), naming the first; Resource for too many of them. Can be
    /// interrupted.
    PlacedSurfaces(const Tracer& tracer, const SceneDescription& description);

    struct Found : NearestTriangle {
        std::uint32_t geometry = kNone, primitive = kNone;  ///< of a shape the primitive is 0
        Vec3 normal;  ///< unit, as a hit has it; 0 where there is none
    };
    [[nodiscard]] Found nearest(const Vec3& point) const;

  private:
    /// A mesh at one place; its triangles follow each other.
    struct Run {
        std::uint32_t first = 0, geometry = 0;
        const PlacedMesh* mesh = nullptr;
        bool placed = false;  ///< by instances
        Placement world;
    };
    struct PlacedShape {
        ExactSurface surface;
        std::uint32_t geometry = 0;
    };
    class Collector;

    explicit PlacedSurfaces(Collector collector);
    /// Ids and normal of a triangle that was found.
    void name(Found& found) const;
    void take_nearer_shape(const Vec3& point, Found& found) const;

    std::vector<Run> runs_;  ///< by `first`
    std::vector<PlacedShape> shapes_;
    NearestTriangles tree_;
    NearestBoxes shape_tree_;
};

}  // namespace alhazen::python
