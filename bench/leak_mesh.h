#pragma once
/// A closed mesh and rays from inside it that are aimed exactly at its weak points: none may get
/// out.
///
/// The mesh is moved to the origin and its vertices are rounded to a grid of 2^21 steps per axis,
/// so that the eighths of its edges, the origins of the rays and the differences of both are exact
/// in float: a ray aimed at a vertex passes through that vertex exactly, in every tracer.
/// Insides are found without tracing: a point's winding number is a sum of solid angles.
/// Source: Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed.
/// Eng. 30(2), 1983.
/// Conventions: a ray that leaks where other parts of the mesh lie behind is not seen; nor need one
/// that touches an edge of a silhouette from inside hit there. Hence rays are endless.
/// Threads: rays may be made from many threads.

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
    /// Throws Error (Usage) when the mesh is not closed or nothing inside was found.
    LeakMesh(std::string name, TriangleMesh mesh);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
    [[nodiscard]] Ray ray(LeakKind kind, RandomStream& random) const;

  private:
    /// All of it is inside; no triangle reaches into it.
    struct Ball {
        Vec3 center;
        double radius;
        /// [axis] vertices whose other two coordinates are within half the radius of the center's.
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
