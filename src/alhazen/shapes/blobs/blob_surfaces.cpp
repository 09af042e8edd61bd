/// The surfaces of a blob in lanes (shapes/core/lane_surfaces.h).
///
/// Source: blob_surface.cpp, the same operations in the same order.
/// Differs: components near any of the eight points are added for all, as 0 where they are not
/// active. Blobs with rods, points beside a component that begins within the step to the surface,
/// and points without a gradient are left to the scalar code.

#include <algorithm>
#include <array>
#include <limits>

#include "alhazen/shapes/blobs/blob.h"
#include "alhazen/shapes/core/lane_surfaces.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/blobs/blob_surfaces.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/shapes/core/lane_surface_formulas-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace blob_surfaces {

using namespace lane_surface_formulas;
template <std::size_t N>
using Mask = LaneMask<double, N>;

/// A component that is active, or nearly so, at some of the points.
struct NearComponent {
    const BlobComponent* component;
    std::uint32_t active;  ///< the lanes where it is
};
struct NearComponents {
    static constexpr std::size_t kMost = 64;
    std::array<NearComponent, kMost> list;
    std::size_t count = 0;
};
template <std::size_t N>
struct Density {
    Numbers<N> value;
    VectorLanes<N> gradient;
};
template <std::size_t N>
HWY_INLINE Density<N> no_density() {
    return {Numbers<N>(0.0), vectors_of<N>({})};
}

/// Adds the component to the sum, as 0 where it is not active, where q > 0.
template <std::size_t N>
HWY_INLINE void add(const BlobComponent& c, const VectorLanes<N>& r, const Numbers<N>& q,
                    const Mask<N>& active, Density<N>& sum) {
    const Numbers<N> own = select_lanes(active, q, Numbers<N>(0.0));
    sum.value = sum.value + Numbers<N>(c.strength) * own * own;
    sum.gradient =
        sum.gradient - (Numbers<N>(4.0 * c.strength) * own / Numbers<N>(c.radius * c.radius)) * r;
}
template <std::size_t N>
HWY_INLINE Numbers<N> profile_of(const BlobComponent& c, const VectorLanes<N>& r) {
    return Numbers<N>(1.0) - dot(r, r) / Numbers<N>(c.radius * c.radius);
}

template <std::size_t N>
HWY_INLINE Box3 box_of(const VectorLanes<N>& p) {
    alignas(64) double rows[3][N];
    store_vectors(p, rows);
    Box3 box;
    for (int k = 0; k < 3; ++k) {
        box.lo[k] = *std::min_element(rows[k], rows[k] + N);
        box.hi[k] = *std::max_element(rows[k], rows[k] + N);
    }
    return box;
}

/// The density at the points, which may move by `margin` afterwards: `near` holds the components
/// that may be active then. False if components are too many, or are rods.
template <std::size_t N>
HWY_INLINE bool density_near(const Blob& blob, const VectorLanes<N>& p, double margin,
                             NearComponents& near, Density<N>& sum) {
    bool fits = true;
    blob.tree->for_box(box_of(p), [&](std::uint32_t i) HWY_ATTR {
        const BlobComponent& c = blob.components[i];
        if (c.rod || near.count == NearComponents::kMost) {
            fits = false;
            return;
        }
        const VectorLanes<N> r = p - vectors_of<N>(c.base);
        const Numbers<N> q = profile_of(c, r);
        // A step s changes the root of 1 - q by s / radius: q <= -4 s / radius stays below 0.
        const double room = 4.0 * margin / c.radius + 0x1p-40;
        if (room < 1.0 && bits_of(q > Numbers<N>(-room)) == 0) return;
        const Mask<N> active = !(q <= Numbers<N>(0.0));
        near.list[near.count++] = {&c, bits_of(active)};
        add(c, r, q, active, sum);
    });
    return fits;
}

template <std::size_t N>
HWY_INLINE std::uint32_t blob_of(const Blob& shape, std::uint32_t wanted, std::size_t first,
                                 LaneSurfaces& lanes) {
    const Numbers<N> nothing(0.0);
    const VectorLanes<N> origin = load_from<N>(lanes.origin, first),
                         d = load_from<N>(lanes.direction, first);
    const VectorLanes<N> far = abs(origin);
    const Numbers<N> margin =
        Numbers<N>(0x1p-48) * (max_lanes(far.x, max_lanes(far.y, far.z)) + Numbers<N>(shape.reach));
    alignas(64) double margins[N];
    store_lanes(margin, margins);
    VectorLanes<N> p = hit_points<N>(lanes, first);
    NearComponents near;
    Density<N> before = no_density<N>(), there = no_density<N>();
    const double most = *std::max_element(margins, margins + N);
    if (!density_near(shape, p, most, near, before)) return 0;
    const Numbers<N> steepness = sqrt(dot(before.gradient, before.gradient));
    Mask<N> sure = steepness > nothing;
    const Numbers<N> off = (Numbers<N>(shape.threshold) - before.value) / steepness;
    const Numbers<N> step =
        select_lanes(off < -margin, -margin, select_lanes(margin < off, margin, off));
    p = p + (step / steepness) * before.gradient;
    std::uint32_t begun = 0;
    for (std::size_t i = 0; i < near.count; ++i) {
        const BlobComponent& c = *near.list[i].component;
        const VectorLanes<N> r = p - vectors_of<N>(c.base);
        const Numbers<N> q = profile_of(c, r);
        const Mask<N> active = !(q <= nothing);
        begun |= bits_of(active) & ~near.list[i].active;
        add(c, r, q, active, there);
    }
    VectorLanes<N> normal = unit_of(-there.gradient, sure);
    normal =
        select_lanes(dot(normal, d) * load_lanes<N>(lanes.v + first) < nothing, -normal, normal);
    return finish(p, normal, sure, wanted & ~begun, first, lanes);
}

std::uint32_t blob(const Blob& shape, std::uint32_t wanted, LaneSurfaces& lanes) {
    return for_lane_blocks(wanted, [&](auto n, std::size_t first, std::uint32_t set)
                                       HWY_ATTR { return blob_of<n()>(shape, set, first, lanes); });
}

}  // namespace blob_surfaces

auto blob_surfaces_of_target() -> std::uint32_t (*)(const Blob&, std::uint32_t, LaneSurfaces&) {
    return &blob_surfaces::blob;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(blob_surfaces_of_target);

std::uint32_t lane_surfaces(const Blob& shape, std::uint32_t wanted, LaneSurfaces& lanes) {
    return ALHAZEN_KERNEL(blob_surfaces_of_target)()(shape, wanted, lanes);
}

}  // namespace alhazen
#endif
