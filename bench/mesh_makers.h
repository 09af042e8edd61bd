#pragma once
/// Procedural meshes for benchmarks: spheres of any tessellation and subdivided copies of a mesh.

#include <cstdint>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen::bench {

/// The unit sphere as an icosahedron whose triangles are split into four `splits` times. Closed.
[[nodiscard]] TriangleMesh icosphere(int splits);

/// The unit sphere as `rings` circles of `sectors` vertices between two poles, 2 rings sectors
/// triangles, with bumps of height `bump`. Closed. Preconditions: rings >= 1, sectors >= 3.
[[nodiscard]] TriangleMesh latitude_ball(std::uint32_t rings, std::uint32_t sectors, double bump);

/// Splits every triangle into four at the midpoints of its edges, which neighbours share: a closed
/// mesh stays closed.
void split_triangles(TriangleMesh& mesh);

/// Appends a scaled and translated copy of `part`.
void append(TriangleMesh& mesh, const TriangleMesh& part, const Vec3& center, double radius);

/// Rounds to the nearest float.
[[nodiscard]] double to_float(double x);
[[nodiscard]] Vec3 to_float(const Vec3& v);
void round_to_float(TriangleMesh& mesh);

}  // namespace alhazen::bench
