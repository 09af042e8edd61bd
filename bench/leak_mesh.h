#pragma once
/// A closed mesh and rays from inside it, aimed exactly at its vertices and edges: every ray must
/// hit.
/// The mesh is moved to the origin and its vertices are rounded to a grid of 2^21 steps per axis,
/// so that the eighths of its edges, the origins of the rays and the differences of both are exact
/// in float: a ray aimed at a vertex passes through that vertex exactly, in every tracer. Inside
/// points are found without tracing: a point's winding number is a sum of solid angles.
/// Limits: a leak is not detected if other parts of the mesh lie behind it, and a ray that touches
/// a silhouette edge from inside need not hit there. Hence rays are infinite.
/// Threads: several threads may make rays.
/// Source: Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed.
/// Eng. 30(2), 1983.

#include <string>

#include "alhazen/geometry/ray.h"
#include "alhazen/sampling/random.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen::bench {

enum class LeakKind {
    Vertex,  ///< at a vertex
    Edge,    ///< at an eighth of an edge
    Axis,    ///< parallel to an axis, through coordinates of vertices
};
inline constexpr int kLeakKinds = 3;
[[nodiscard]] const char* name_of(LeakKind kind);

class LeakMesh {
  public:
    /// Throws Error (Usage) if the mesh is not closed or no inside point is found.
    LeakMesh(std::string name, TriangleMesh mesh);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
    [[nodiscard]] Ray ray(LeakKind kind, RandomStream& random) const;

  private:
    /// A ball inside the mesh that no triangle intersects.
    struct Ball {
        Vec3 center;
        double radius;
        /// [axis] vertices whose other two coordinates differ from the center's by less than half
        /// the radius.
        std::array<std::vector<std::uint32_t>, 3> lines;
    };

    void snap_to_grid();
    void find_balls();
    /// A grid point in the ball, at most half the radius from the center along each axis.
    [[nodiscard]] Vec3 point_in(const Ball& ball, RandomStream& random) const;
    [[nodiscard]] Ray axis_ray(const Ball& ball, RandomStream& random) const;

    std::string name_;
    TriangleMesh mesh_;
    double grid_ = 0;  ///< step of origins and aims; vertices lie on multiples of eight
    std::vector<Ball> balls_;
};

}  // namespace alhazen::bench
