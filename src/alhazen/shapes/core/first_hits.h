#pragma once
/// The first crossings of a packet of rays with one shape.
///
/// Conventions: each ray has the bits of `find_first_hit`. A shape with a packet test declares
/// `std::uint32_t first_hits(const S&, std::span<const Ray* const>, ShapeHit*)` in its own header:
/// takes one to `kMostRaysAtOnce<S>` valid rays, returns the set of rays that hit (bit i for ray i)
/// and writes their first crossings to [ray]. first_hits_test.cpp compares the two.

#include <cstdint>
#include <span>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/core/shape.h"

namespace alhazen {

inline constexpr std::size_t kMaxPacketRays = kRayLanes;

/// Patches gain from larger packets, of any directions (patch_apart.h).
inline constexpr std::size_t kMostPatchRays = 32;

struct BezierPatch;
struct PatchMesh;

/// Largest packet of a shape's packet test.
template <class S>
inline constexpr std::size_t kMostRaysAtOnce = kMaxPacketRays;
template <>
inline constexpr std::size_t kMostRaysAtOnce<BezierPatch> = kMostPatchRays;
template <>
inline constexpr std::size_t kMostRaysAtOnce<PatchMesh> = kMostPatchRays;

/// Shapes with a packet test.
template <class S>
concept HasPacketTest = requires(const S& shape, std::span<const Ray* const> rays, ShapeHit* hits) {
    first_hits(shape, rays, hits);
};

}  // namespace alhazen
