#pragma once
/// Test rays: random lines, rays on a coarse lattice (axis-parallel, through faces and edges, with
/// negative zeros), eye rays, rays aimed exactly at vertices and edges; and sets of coherent rays:
/// tiles of eye rays, shadow rays towards a point or in one direction.

#include <cstddef>
#include <span>
#include <vector>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/sampling/random.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// Generates rays of every kind in turn.
class VerifyRays {
  public:
    /// Number of rays in a tile: a block of 8x8 pixels.
    static constexpr std::size_t kTileRays = 64;

    struct Sample {
        const char* kind;
        Ray ray;
    };

    /// `camera` may be null. `table` supplies vertices to aim at.
    VerifyRays(const Box3& bounds, const Camera* camera, const PrimitiveTable& table,
               std::uint64_t seed);

    [[nodiscard]] Sample next();

    /// Appends the eye rays of a tile in the order of the renderers' pixels: rays of the camera at
    /// some resolution, or around a ray of another kind. Every fourth tile is the camera's. The
    /// width of a pixel is 2^-3 to 2^-10 of the distance: some tiles are too wide for a packet.
    void append_tile(std::vector<Sample>& samples);
    /// Appends a ray from each origin: to one point, where it ends, or in one direction.
    void append_shadow_rays(std::span<const Vec3> origins, std::vector<Sample>& samples);

    /// A ray from outside the bounds through two uniform points in them.
    [[nodiscard]] Ray random_line();
    /// Origin and direction on a grid of 1/8 of the bounds; often axis-parallel, with zeros of
    /// either sign.
    [[nodiscard]] Ray lattice_ray();
    /// A ray from a uniform point through a vertex, an edge or the inside of a triangle;
    /// random_line if there are no triangles.
    [[nodiscard]] Ray aimed_ray();

  private:
    [[nodiscard]] Vec3 uniform_point();
    /// The middle ray of a tile that is not the camera's.
    [[nodiscard]] Ray middle_ray();

    Box3 bounds_;
    const Camera* camera_;
    const PrimitiveTable& table_;
    RandomStream random_;
    std::uint64_t count_ = 0, tiles_ = 0;
};

}  // namespace alhazen
