#pragma once
/// Rays that find mistakes: random lines, rays on a coarse lattice (axis-parallel, through faces
/// and edges, with negative zeros), eye rays, rays aimed exactly at vertices and edges.

#include <functional>
#include <string>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/sampling/random.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// Makes rays of every kind in turn.
class VerifyRays {
  public:
    struct Sample {
        const char* kind;
        Ray ray;
    };

    /// `camera` may be null. `table` is asked for vertices to aim at.
    VerifyRays(const Box3& bounds, const Camera* camera, const PrimitiveTable& table,
               std::uint64_t seed);

    [[nodiscard]] Sample next();

    /// A ray through two uniform points of the bounds, from outside them.
    [[nodiscard]] Ray random_line();
    /// Origin and direction on a grid of 1/8 of the bounds; often axis-parallel, with zeros of
    /// either sign.
    [[nodiscard]] Ray lattice_ray();
    /// From a uniform point through a vertex, an edge or the inside of a triangle; random_line
    /// without triangles.
    [[nodiscard]] Ray aimed_ray();

  private:
    [[nodiscard]] Vec3 uniform_point();

    Box3 bounds_;
    const Camera* camera_;
    const PrimitiveTable& table_;
    RandomStream random_;
    std::uint64_t count_ = 0;
};

}  // namespace alhazen
