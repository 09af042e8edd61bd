#include "alhazen/shapes/polygons/polygon_lanes.h"

#include <array>
#include <bit>
#include <limits>

#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/polygons/polygon_cells.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/polygons/polygon_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

static_assert(kRayLanes == kLaneCount);

/// Largest number of rays near an edge, of a polygon with cells, that are left to the scalar
/// function.
constexpr int kMostAlone = 4;

#include "alhazen/geometry/watertight_triangle_formulas-inl.h"

struct RayRows {
    std::array<Doubles, 3> o, d;
    Doubles t_min, t_max;

    explicit RayRows(const RayLanes& rays)
        : t_min(load_lanes(rays.t_min)), t_max(load_lanes(rays.t_max)) {
        for (std::size_t k = 0; k < 3; ++k) {
            o[k] = load_lanes(rays.origin[k]);
            d[k] = load_lanes(rays.direction[k]);
        }
    }
    [[nodiscard]] std::uint32_t covers(const Doubles& t) const {
        return bits_of((t_min <= t) & (t <= t_max));
    }
};

/// The crossings with the plane, with the terms of their error bounds.
struct PlaneCrossings {
    Doubles t, cosine;
    std::array<Doubles, 3> size;
};

/// Computes the crossings with the plane. Returns the rays that the polygon's box does not exclude.
std::uint32_t intersect_plane(const Polygon& polygon, const RayRows& rays, PlaneCrossings& met) {
    const Vec3& n = polygon.normal;
    const auto along = [&](const std::array<Doubles, 3>& v) {
        return Doubles(n.x) * v[0] + Doubles(n.y) * v[1] + Doubles(n.z) * v[2];
    };
    std::array<Doubles, 3> to_plane;
    auto& [t, cosine, size] = met;
    for (int k = 0; k < 3; ++k) to_plane.data()[k] = Doubles(polygon.point[k]) - rays.o.data()[k];
    const Doubles gamma(gamma_bound(16));
    cosine = along(rays.d);
    t = along(to_plane) / cosine;
    for (std::size_t k = 0; k < 3; ++k) {
        size.data()[k] = abs(to_plane.data()[k]) + abs(t) * abs(rays.d.data()[k]);
    }
    const Doubles t_slack =
        (Doubles(polygon.off_plane) + gamma * (size[0] + size[1] + size[2])) / abs(cosine);
    auto missed = (t + t_slack < rays.t_min) | (t - t_slack > rays.t_max);
    for (int k = 0; k < 3; ++k) {
        const Doubles o = rays.o.data()[k], d = rays.d.data()[k];
        const Doubles p = o + t * d;
        const Doubles slack = t_slack * abs(d) + gamma * (abs(o) + size.data()[k]);
        missed = missed | (p + slack < Doubles(polygon.bounds.lo[k])) |
                 (p - slack > Doubles(polygon.bounds.hi[k]));
    }
    return ~bits_of(missed);
}

/// `clamped_to_box` of polygon.cpp in lanes.
Doubles clamped_to_box(const Doubles& t, const RayRows& rays, const Box3& box) {
    const Doubles zero(0.0), half(0.5);
    Doubles lo(-std::numeric_limits<double>::infinity());
    Doubles hi(std::numeric_limits<double>::infinity());
    for (int k = 0; k < 3; ++k) {
        const Doubles o = rays.o.data()[k], d = rays.d.data()[k];
        const auto forward = d > zero;
        const auto moves = forward | (d < zero);
        const Doubles divisor = select_lanes(moves, d, Doubles(1.0));
        const Doubles first(box.lo[k]), last(box.hi[k]);
        const Doubles enters = (select_lanes(forward, first, last) - o) / divisor;
        const Doubles leaves = (select_lanes(forward, last, first) - o) / divisor;
        lo = select_lanes(moves & (lo < enters), enters, lo);
        hi = select_lanes(moves & (leaves < hi), leaves, hi);
    }
    const Doubles inside = select_lanes(t > lo, select_lanes(hi < t, hi, t), lo);
    return select_lanes(lo <= hi, inside, half * lo + half * hi);
}

/// The rays of `among` whose crossing is inside the polygon, as by the scalar function. `kz`: their
/// dominant axis. Adds rays that need the scalar function to `unsure`.
std::uint32_t surrounded(const Polygon& polygon, const RayRows& rays, int kz, std::uint32_t among,
                         std::uint32_t& unsure) {
    const int kx = kz == 2 ? 0 : kz + 1, ky = kx == 2 ? 0 : kx + 1;
    const Doubles dz = rays.d.data()[kz], zero(0.0);
    const Doubles sx = rays.d.data()[kx] / dz, sy = rays.d.data()[ky] / dz;
    const Doubles ox = rays.o.data()[kx], oy = rays.o.data()[ky], oz = rays.o.data()[kz];
    const auto vertex = [&](std::size_t i) {
        const Vec3& p = polygon.vertices.data()[i];
        return sheared<Doubles>(Doubles(p[kx]), Doubles(p[ky]), Doubles(p[kz]), ox, oy, oz, sx, sy);
    };
    std::uint32_t inside = 0;
    std::size_t first = 0;
    for (const std::size_t end : polygon.loop_ends) {
        ShearedVertex<Doubles> a = vertex(end - 1);
        std::uint32_t before = bits_of(a.y > zero);
        for (std::size_t i = first; i < end; ++i) {
            const ShearedVertex<Doubles> b = vertex(i);
            const std::uint32_t here = bits_of(b.y > zero);
            const std::uint32_t crossing = (before ^ here) & among;
            if (crossing != 0) {
                const std::uint32_t right = bits_of((a.x > zero) & (b.x > zero));
                const std::uint32_t left = bits_of((a.x < zero) & (b.x < zero));
                inside ^= crossing & right;
                const std::uint32_t mixed = crossing & ~right & ~left;
                if (mixed != 0) {
                    const Doubles p = a.x * b.y, q = a.y * b.x;
                    const std::uint32_t more = bits_of(p > q), less = bits_of(p < q);
                    inside ^= mixed & (more | less) & ~(more ^ here);
                    unsure |= mixed & ~(more | less);
                }
            }
            before = here;
            a = b;
        }
        first = end;
    }
    return inside;
}

/// `place_in_cells` of polygon.cpp in lanes. Returns the rays of `among` that are inside; takes
/// those that are outside, or inside, from `among`.
std::uint32_t decide_by_cells(const Polygon& polygon, const RayRows& rays,
                              const PlaneCrossings& met, std::uint32_t& among) {
    const PolygonCells& cells = *polygon.cells;
    const Doubles gamma(gamma_bound(16)), across(PolygonCells::kAcross);
    const Doubles slack =
        gamma * (met.size[0] + met.size[1] + met.size[2] + Doubles(cells.reach()));
    const Doubles along_ray =
        Doubles(PolygonCells::kAlongRay) * (Doubles(polygon.off_plane) + slack);
    const Doubles cosine = abs(met.cosine);
    std::uint32_t sure = among & bits_of(cosine > Doubles(PolygonCells::kLeastCosine));
    alignas(64) double at[2][kRayLanes];
    for (std::size_t k = 0; k < 2; ++k) {
        const int axis = cells.axes().data()[k];
        const Doubles o = rays.o.data()[axis], d = rays.d.data()[axis];
        const Doubles room = Doubles(cells.margin().data()[k]) - across * (slack + gamma * abs(o));
        const Doubles most = room * cosine;
        sure &= bits_of((along_ray * abs(d) <= most) & (most > Doubles(PolygonCells::kLeastRoom)));
        store_lanes(o + met.t * d, at[k]);
    }
    std::uint32_t inside = 0;
    for_each_lane(sure, [&](std::size_t i) {
        const PolygonCells::Place place = cells.place_of(at[0][i], at[1][i]);
        if (place == PolygonCells::Place::NearEdge) return;
        among &= ~(1u << i);
        inside |= std::uint32_t{place == PolygonCells::Place::Inside} << i;
    });
    return inside;
}

void polygon_hits(const RayLanes& lanes, const Polygon& polygon, std::uint32_t wanted,
                  PolygonHitLanes& out) {
    out.hit = out.unsure = 0;
    const RayRows rays(lanes);
    PlaneCrossings met;
    std::uint32_t left = wanted & intersect_plane(polygon, rays, met);
    if (left == 0) return;
    const Doubles at = clamped_to_box(met.t, rays, polygon.bounds);
    left &= rays.covers(at) & bits_of(abs(at) < Doubles(std::numeric_limits<double>::infinity()));
    if (left == 0) return;
    store_lanes(at, out.t);
    if (polygon.cells) {
        out.hit = decide_by_cells(polygon, rays, met, left);
        // One ray against eight corners takes fewer steps than eight rays against each corner.
        if (std::popcount(left) <= kMostAlone) {
            out.unsure = left;
            return;
        }
    }
    if (left == 0) return;
    const auto axis_of = [&](std::size_t i) {
        return dominant_axis({lanes.direction[0][i], lanes.direction[1][i], lanes.direction[2][i]});
    };
    const int kz = axis_of(static_cast<std::size_t>(std::countr_zero(left)));
    std::uint32_t others = 0;
    for_each_lane(left, [&](std::size_t i) { others |= std::uint32_t{axis_of(i) != kz} << i; });
    out.unsure = others;
    const std::uint32_t inside = surrounded(polygon, rays, kz, left & ~others, out.unsure);
    out.hit |= inside & left & ~out.unsure;
}

}  // namespace

using PolygonHitsKernel = void (*)(const RayLanes&, const Polygon&, std::uint32_t,
                                   PolygonHitLanes&);
PolygonHitsKernel polygon_hits_of_target() {
    return &polygon_hits;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(polygon_hits_of_target);

std::uint32_t first_hits(const Polygon& shape, const RayLanes& rays, std::uint32_t wanted,
                         ShapeHit* hits) {
    PolygonHitLanes lanes;
    ALHAZEN_KERNEL(polygon_hits_of_target)()(rays, shape, wanted, lanes);
    std::uint32_t hit = lanes.hit;
    for_each_lane(hit, [&](std::size_t i) { hits[i] = {lanes.t[i], 0, 0, 0}; });
    for_each_lane(lanes.unsure, [&](std::size_t i) {
        if (find_first_hit(shape, rays.ray(i), hits[i])) hit |= 1u << i;
    });
    return hit;
}

}  // namespace alhazen
#endif
