#pragma once
/// Points and normals of surfaces at up to sixteen hits, in lanes.
///
/// Conventions: each lane has the values of `plain_surface` (zeros may differ in sign), or is left
/// to it. A shape with lanes declares `std::uint32_t lane_surfaces(const S&, std::uint32_t wanted,
/// LaneSurfaces&)` in its own header, for hits on part 0 of one shape; it returns the lanes of
/// `wanted` that it has set. lane_surfaces_test.cpp compares the two. Other lanes hold copies of
/// hits. Threads: functions may be called from many threads.

#include <cstdint>

#include "alhazen/geometry/placement.h"
#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/core/shape.h"

namespace alhazen {

/// Registers of eight doubles hold them in two, where there are such.
inline constexpr std::size_t kSurfaceLanes = 16;

/// Copies the first lane of a row, or of each row, to the lanes from `count` on.
inline void fill_lanes(double (&row)[kSurfaceLanes], std::size_t count) {
    for (std::size_t i = count; i < kSurfaceLanes; ++i) row[i] = row[0];
}
inline void fill_lanes(double (&rows)[3][kSurfaceLanes], std::size_t count) {
    for (auto& row : rows) fill_lanes(row, count);
}

struct alignas(64) LaneSurfaces {
    // ---- the hits
    double origin[3][kSurfaceLanes],
        direction[3][kSurfaceLanes];            ///< rays in the frame of the shape
    double t[kSurfaceLanes], v[kSurfaceLanes];  ///< as ShapeHit
    // ---- the surfaces: `normal` is the shading normal, too
    double point[3][kSurfaceLanes], normal[3][kSurfaceLanes];

    void set(std::size_t lane, const Ray& ray, const ShapeHit& hit) {
        for (int k = 0; k < 3; ++k) {
            origin[k][lane] = ray.origin[k];
            direction[k][lane] = ray.direction[k];
        }
        t[lane] = hit.t;
        v[lane] = hit.v;
    }
};

template <class S>
concept HasLaneSurfaces = requires(const S& shape, LaneSurfaces& lanes) {
    lane_surfaces(shape, 0u, lanes);
};

/// Transforms the first `count` points and normals out of an inner frame, as `set_surface` does.
void carry_lanes_outward(const Placement& placement, std::size_t count, LaneSurfaces& lanes);
/// The same for the identity.
void carry_lanes_in_place(std::size_t count, LaneSurfaces& lanes);

}  // namespace alhazen
