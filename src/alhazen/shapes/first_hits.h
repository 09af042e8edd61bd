#pragma once
/// The first crossings of several rays with one shape, side by side where it can.
///
/// Source: polynomial_lanes.h, blob_lanes.h, sphere_lanes.h. Differs: nothing. Conventions: for
/// each ray the bits of `find_first_hit`. A shape with an overload here has to join
/// first_hits_test.cpp, which compares them.

#include <cstdint>
#include <span>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/algebraic.h"
#include "alhazen/shapes/blob.h"
#include "alhazen/shapes/sphere.h"
#include "alhazen/shapes/torus.h"

namespace alhazen {

/// So many rays at most.
inline constexpr std::size_t kMostRaysSideBySide = kRayLanes;

/// The set of rays that hit, bit i for ray i; [ray] their first crossings. One to eight valid rays.
[[nodiscard]] std::uint32_t first_hits(const Algebraic& shape, std::span<const Ray* const> rays,
                                       ShapeHit* hits);
[[nodiscard]] std::uint32_t first_hits(const Blob& shape, std::span<const Ray* const> rays,
                                       ShapeHit* hits);
[[nodiscard]] std::uint32_t first_hits(const Sphere& shape, std::span<const Ray* const> rays,
                                       ShapeHit* hits);
[[nodiscard]] std::uint32_t first_hits(const Torus& shape, std::span<const Ray* const> rays,
                                       ShapeHit* hits);

/// The same for the rays of a set that lie in lanes already; hits lane by lane.
[[nodiscard]] std::uint32_t first_hits(const Sphere& shape, const RayLanes& rays,
                                       std::uint32_t wanted, ShapeHit* hits);

/// Shapes that have one for rays where they are.
template <class S>
concept HitSideBySide = requires(const S& shape, std::span<const Ray* const> rays, ShapeHit* hits) {
    first_hits(shape, rays, hits);
};

}  // namespace alhazen
