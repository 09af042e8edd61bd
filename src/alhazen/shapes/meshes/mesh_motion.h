#pragma once
/// Vertices of a mesh that move while the shutter is open.
///
/// Source: Cook, Porter and Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984, section 4.5 (each
/// ray has a time, and meets things where they are then).
/// Conventions: time 0: the shutter opens; 1: it closes; keys may lie outside. Between two keys
/// positions and normals change linearly; before the first and after the last nothing moves.
/// Threads: const functions may be called from many.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/motion/moving_box.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

struct MeshKey {
    double time = 0;
    std::vector<Vec3> positions;  ///< [vertex]
    std::vector<Vec3> normals;    ///< [vertex], or empty: those of the mesh
};

/// What is wrong with the keys of `mesh`; null where nothing is.
[[nodiscard]] const char* fault_of(const TriangleMesh& mesh, std::span<const MeshKey> keys);

class MeshMotion {
  public:
    using Corners = std::array<std::uint32_t, 3>;

    /// Precondition: keys without fault, at least one.
    explicit MeshMotion(std::vector<MeshKey> keys) : keys_(std::move(keys)) {}

    [[nodiscard]] std::array<Vec3, 3> positions_at(const Corners& corners, double time) const;
    /// Contains the triangle at every time from 0 to 1; empty where two of its vertices are one.
    [[nodiscard]] MovingBox box(const Corners& corners) const;
    /// The triangle alone, with all attributes it has at that time.
    [[nodiscard]] TriangleMesh triangle_at(const TriangleMesh& mesh, std::size_t triangle,
                                           double time) const;
    /// Moves all vertices to where they are then.
    void pose(double time, TriangleMesh& mesh) const;
    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    /// Between key `i` and the next; `share` 0 is the key itself.
    struct Moment {
        std::size_t i;
        double share;
    };
    [[nodiscard]] Moment moment(double time) const;
    [[nodiscard]] Vec3 position(std::uint32_t vertex, const Moment& m) const;
    [[nodiscard]] Vec3 normal(std::uint32_t vertex, const Moment& m) const;

    std::vector<MeshKey> keys_;
};

}  // namespace alhazen
