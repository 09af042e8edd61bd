#pragma once
/// Tests whether faces are near the surface of a solid, and turned to its outside.
///
/// Conventions: near is within half the tolerance along a few directions (surface_line.h); the
/// points of a triangle whose barycentric coordinates are quarters are tested. What was tested and
/// has not changed is not tested again: `is_near` of edges and vertices keeps the result.
/// Threads: `test` uses several, with the same result for any number.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "alhazen/solids/triangles/surface_faces.h"
#include "alhazen/solids/triangles/surface_line.h"

namespace alhazen {

class FaceTests {
  public:
    using FaceOf = std::function<SurfaceFace(const SurfaceEdge&)>;

    /// `limit`: half the tolerance. The solid and the vertices must outlive the object.
    FaceTests(const IsolatedSolid& solid, std::vector<SurfaceVertex>& vertices, double limit)
        : solid_(solid), vertices_(vertices), limit_(limit) {}

    /// Sets `is_near` of some edges, by number, and of the vertices of their faces.
    void test(const std::vector<std::uint32_t>& numbers, std::vector<SurfaceEdge>& edges,
              const FaceOf& face_of);
    /// Largest distance of corners and middles of a face from the surface, of those up to `most`.
    [[nodiscard]] double distance_of(const SurfaceFace& face, SurfaceLine& line, double most) const;

  private:
    using Triangle = std::array<std::uint32_t, 3>;

    [[nodiscard]] const Vec3& point(std::uint32_t number) const { return vertices_[number].point; }
    bool is_face_near(const SurfaceEdge& edge, const SurfaceFace& face, SurfaceLine& line) const;
    /// False if a triangle of a face is turned over: it faces away from the surface at the edge and
    /// at its corners, and from the surface near its middle.
    bool is_turned_out(const SurfaceEdge& edge, const Triangle& t, SurfaceLine& line) const;
    /// Tests the points of an edge between two vertices in one of the triangles beside it.
    bool is_near(const Triangle& t, SurfaceLine& line) const;

    const IsolatedSolid& solid_;
    std::vector<SurfaceVertex>& vertices_;
    double limit_;
};

}  // namespace alhazen
