#pragma once
/// All triangles of a scene where they are placed, for questions about the nearest one.
///
/// Conventions: those of nearest_triangles.h, in world space. Triangles of instances are copied
/// once for each place. Ids are those of the hits of a Tracer.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "alhazen/geometry/nearest/nearest_triangles.h"
#include "alhazen/geometry/placement.h"
#include "alhazen/scene_model/scene_description.h"
#include "alhazen/tracer/tracer.h"

namespace alhazen::python {

class PlacedTriangles {
  public:
    /// More are refused where there are instances: their tree would take 5.5 GB.
    static constexpr std::size_t kMost = std::size_t{1} << 25;

    /// Throws Error: Usage where there are shapes or solids, which have no triangles, naming the
    /// first; Resource for too many triangles. Can be interrupted.
    PlacedTriangles(const Tracer& tracer, const SceneDescription& description);

    struct Found : NearestTriangle {
        std::uint32_t geometry = kNone, primitive = kNone;
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
    class Collector;

    std::vector<Run> runs_;  ///< by `first`
    NearestTriangles tree_;
};

}  // namespace alhazen::python
