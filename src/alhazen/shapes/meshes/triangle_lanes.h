#pragma once
/// The surfaces at hits of triangles of meshes, for up to sixteen hits in lanes.
///
/// Conventions: the bits are those of TriangleMesh::surface on every target. Lanes without a hit
/// hold a triangle, too.

#include <cstddef>
#include <cstdint>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// The rounding of the test of the next ray, relative to the largest distance of a vertex from the
/// point along any axis. It is not relative to the position of the point, and acts along any axis:
/// in the plane z = 0 the test does not compute a distance of exactly 0.
inline constexpr double kNextTestRounding = 12 * 0x1p-53;

struct TriangleLanes {
    static constexpr std::size_t kMost = 16;
    using Numbers = double[kMost];  ///< [lane]
    using Vectors = Numbers[3];     ///< [axis]

    /// Fills all lanes with a triangle.
    TriangleLanes();

    /// Empties all lanes.
    void clear() { smooth = mapped = mirrored = 0; }
    /// Fills an empty lane with a hit whose u, v are the weights of the second and third vertex.
    /// `mirrored`: the normal is turned, and with it a shading normal that does not come from
    /// vertices.
    void set(std::size_t lane, const TriangleMesh& mesh, std::size_t triangle, const ShapeHit& hit,
             bool mirrored);
    /// Computes the surfaces of the first `count` lanes.
    void find_surfaces(std::size_t count);

    alignas(64) Vectors corners[3] = {};  ///< [vertex]
    alignas(64) Vectors normals[3] = {};  ///< [vertex]; of lanes in `smooth`
    alignas(64) Numbers uvs[3][2] = {};   ///< [vertex]; of lanes in `mapped`
    alignas(64) Numbers u = {}, v = {};
    std::uint32_t smooth = 0, mapped = 0, mirrored = 0;  ///< bits of lanes

    // Results: members of ShapeSurface; `error` includes the rounding of the next test.
    alignas(64) Vectors point = {}, error = {}, normal = {}, shading_normal = {}, dpdu = {};
};

}  // namespace alhazen
