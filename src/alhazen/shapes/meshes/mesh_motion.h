#pragma once
/// Vertices of a mesh that move while the shutter is open.
///
/// Source: Cook, Porter and Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984, section 4.5 (each
/// ray has a time, at which it intersects the scene).
/// Conventions: the shutter opens at time 0 and closes at 1; keys may lie outside. Positions and
/// normals are interpolated linearly between two keys and constant before the first and after the
/// last.
/// Threads: const functions may be called concurrently.

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

/// Describes what is wrong with the keys of `mesh`; null if nothing is.
[[nodiscard]] const char* fault_of(const TriangleMesh& mesh, std::span<const MeshKey> keys);

class MeshMotion {
  public:
    using Corners = std::array<std::uint32_t, 3>;

    /// Precondition: at least one key, without fault.
    explicit MeshMotion(std::vector<MeshKey> keys) : keys_(std::move(keys)) {}

    [[nodiscard]] std::array<Vec3, 3> positions_at(const Corners& corners, double time) const;
    /// Bounds the triangle at all times from 0 to 1; empty if two of its vertices coincide.
    [[nodiscard]] MovingBox box(const Corners& corners) const;
    /// The triangle as a mesh, with all its attributes at `time`.
    [[nodiscard]] TriangleMesh triangle_at(const TriangleMesh& mesh, std::size_t triangle,
                                           double time) const;
    /// Moves all vertices to their positions at `time`.
    void pose(double time, TriangleMesh& mesh) const;
    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    /// Between key `i` and the next; `share` 0 is key `i`.
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
