#include "alhazen/csg/csg_lanes.h"

#include <bit>
#include <limits>

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/csg/csg_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/math/constants.h"
#include "alhazen/shapes/span_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

constexpr std::uint32_t kMaxLeaves = CsgLanesSolid::kMaxLeaves;

HWY_INLINE Doubles largest(const Doubles& x, const Doubles& y, const Doubles& z) {
    return max_lanes(max_lanes(abs(x), abs(y)), abs(z));
}

/// The minimum distance between crossings along the dominant axis, on which rays move by `speed`.
struct Apart {
    Doubles length, speed;

    HWY_INLINE Apart(const CsgLanesSolid& solid, const RayLanes& rays) : length(0.0), speed(0.0) {
        const Vec3Lanes away = load_ray_vectors(rays.origin) - solid.center;
        const Vec3Lanes d = load_ray_vectors(rays.direction);
        length = Doubles(solid.apart) * (Doubles(solid.size) + largest(away.x, away.y, away.z));
        speed = largest(d.x, d.y, d.z);
    }
    /// The distance as a difference of the rays' parameters.
    [[nodiscard]] HWY_INLINE Doubles parameter() const { return length / speed; }
};

HWY_INLINE LaneMask<double> far_outside(const CsgLanesSolid::Leaf& leaf, const Vec3Lanes& point,
                                        const Doubles& margin) {
    switch (leaf.kind) {
        case CsgLanesSolid::Kind::Sphere:
            return far_outside(*static_cast<const Sphere*>(leaf.shape), point, margin);
        case CsgLanesSolid::Kind::Box:
            return far_outside(*static_cast<const BoxShape*>(leaf.shape), point, margin);
        case CsgLanesSolid::Kind::Frustum:
            return far_outside(*static_cast<const Frustum*>(leaf.shape), point, margin);
        case CsgLanesSolid::Kind::None:
            break;
    }
    return margin < margin;
}

/// True if only the entry of the first leaf matters for each ray that crosses it: that leaf is the
/// only needed one, and the others are far from the entry. `hit` then receives the rays that enter
/// the solid.
HWY_INLINE bool settled_by_first(const CsgLanesSolid& solid, const RayLanes& rays,
                                 const LaneSpans& first, std::uint32_t& hit) {
    const Apart apart(solid, rays);
    const Vec3Lanes o = load_ray_vectors(rays.origin), d = load_ray_vectors(rays.direction);
    const Doubles t_min = load_lanes(rays.t_min), t_max = load_lanes(rays.t_max);
    // A crossing slightly behind the end may count as one with a crossing before it.
    const LaneMask<double> beyond =
        ((first.entry - t_max) * apart.speed > apart.length) | (first.exit < t_min);
    // At least twice the distance in space of separate crossings: a length of a ray is at most 1.8
    // times that along its dominant axis.
    const Doubles margin = Doubles(4.0) * apart.length;
    LaneMask<double> settled = (first.entry >= t_min) & (first.entry <= t_max) &
                               ((first.exit - first.entry) * apart.speed > margin);
    const Vec3Lanes point{o.x + first.entry * d.x, o.y + first.entry * d.y,
                          o.z + first.entry * d.z};
    for (std::uint32_t i = 1; i < solid.leaf_count; ++i) {
        settled = settled & far_outside(solid.leaves[i], point, margin);
    }
    hit = first.met & ~bits_of(beyond);
    return (hit & ~bits_of(settled)) == 0;
}

/// The spans of the leaves that any ray intersects.
struct Spans {
    std::uint32_t count = 0;
    std::uint32_t place[kMaxLeaves];  ///< indices among the leaves of the solid
    LaneSpans of[kMaxLeaves];         ///< empty if the ray misses the leaf

    /// Returns storage for the spans of the next leaf.
    HWY_INLINE LaneSpans& begin() {
        of[count].met = of[count].unsure = 0;  // the rest is written if the leaf is hit
        return of[count];
    }
    /// Keeps these spans, for the rays that intersect the leaf.
    HWY_INLINE void keep(std::uint32_t leaf) {
        LaneSpans& spans = of[count];
        const LaneMask<double> mask = lanes_of_bits<double>(spans.met);
        spans.entry = select_lanes(mask, spans.entry, Doubles(kInfinity));
        spans.exit = select_lanes(mask, spans.exit, Doubles(-kInfinity));
        place[count++] = leaf;
    }
    /// The rays with two crossings closer than `apart`.
    [[nodiscard]] HWY_INLINE std::uint32_t close(const Doubles& apart) const {
        const auto near = [&](const Doubles& a, const Doubles& b)
                              HWY_ATTR { return abs(a - b) <= apart; };
        std::uint32_t lanes = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            LaneMask<double> found = near(of[i].entry, of[i].exit);
            for (std::uint32_t j = 0; j < i; ++j) {
                found = found | near(of[i].entry, of[j].entry) | near(of[i].entry, of[j].exit) |
                        near(of[i].exit, of[j].entry) | near(of[i].exit, of[j].exit);
            }
            lanes |= bits_of(found);
        }
        return lanes;
    }
    /// The rays that enter or leave the solid where they cross leaf i of the list at t.
    [[nodiscard]] HWY_INLINE std::uint32_t changed(const CsgLanesSolid& solid, std::uint32_t i,
                                                   const Doubles& t) const {
        std::uint32_t inside[kMaxLeaves] = {};
        for (std::uint32_t j = 0; j < count; ++j) {
            if (j != i) inside[place[j]] = bits_of((of[j].entry < t) & (t < of[j].exit));
        }
        std::uint32_t lanes = 0;
        for (std::uint64_t rest = solid.leaves[place[i]].changes; rest != 0; rest &= rest - 1) {
            const auto set = static_cast<std::uint32_t>(std::countr_zero(rest));
            std::uint32_t there = of[i].met;
            for (std::uint32_t k = 0; k < solid.leaf_count; ++k) {
                there &= (set >> k & 1) != 0 ? inside[k] : ~inside[k];
            }
            lanes |= there;
        }
        return lanes;
    }
};

HWY_INLINE void find_spans(const CsgLanesSolid::Leaf& leaf, const RayLanes& rays,
                           std::uint32_t wanted, LaneSpans& spans) {
    switch (leaf.kind) {
        case CsgLanesSolid::Kind::Sphere:
            return find_spans(rays, *static_cast<const Sphere*>(leaf.shape), wanted, spans);
        case CsgLanesSolid::Kind::Box:
            return find_spans(rays, *static_cast<const BoxShape*>(leaf.shape), wanted, spans);
        case CsgLanesSolid::Kind::Frustum:
            return find_spans(rays, *static_cast<const Frustum*>(leaf.shape), wanted, spans);
        case CsgLanesSolid::Kind::None:
            spans.unsure = wanted;
    }
}

HWY_FLATTEN std::uint32_t first(const CsgLanesSolid& solid, const RayLanes& rays,
                                std::uint32_t wanted, LaneHits& hits, CsgLanesReport& report) {
    report.unsure = report.tests = report.tests_met = 0;
    const Doubles t_min = load_lanes(rays.t_min), t_max = load_lanes(rays.t_max);
    Doubles apart(0.0);
    Spans spans;
    for (std::uint32_t i = 0; i < solid.leaf_count; ++i) {
        const CsgLanesSolid::Leaf& leaf = solid.leaves[i];
        LaneSpans& found = spans.begin();
        find_spans(leaf, rays, wanted, found);
        report.tests += static_cast<std::uint32_t>(std::popcount(wanted & ~found.unsure));
        report.tests_met += static_cast<std::uint32_t>(std::popcount(found.met));
        report.unsure |= found.unsure;
        if (i == 0 && solid.begins_with_first && found.unsure == 0) {
            if (found.met == 0) return 0;
            std::uint32_t hit;
            if (settled_by_first(solid, rays, found, hit)) {
                store_lanes(found.entry, hits.t);
                store_lanes(found.entry_part, hits.part);
                store_lanes(Doubles(static_cast<double>(leaf.id)), hits.primitive);
                return hit;
            }
        }
        if (leaf.needed) {
            if (found.met != 0) {
                if (spans.count == 0) apart = Apart(solid, rays).parameter();
                // A crossing slightly behind the end may count as one with a crossing before it.
                found.met &= bits_of((found.entry <= t_max + apart) & (found.exit >= t_min));
            }
            wanted &= found.met | found.unsure;
            if (wanted == 0) return 0;
        }
        if (found.met != 0) {
            if (spans.count == 0 && !leaf.needed) apart = Apart(solid, rays).parameter();
            spans.keep(i);
        }
    }
    report.unsure = (report.unsure | spans.close(apart)) & wanted;
    wanted &= ~report.unsure;
    Doubles best(kInfinity), best_leaf(0.0), best_part(0.0);
    for (std::uint32_t i = 0; i < spans.count; ++i) {
        const LaneSpans& of = spans.of[i];
        for (int side = 0; side < 2; ++side) {
            const Doubles& t = side == 0 ? of.entry : of.exit;
            const LaneMask<double> nearer = (t >= t_min) & (t <= t_max) & (t < best);
            const std::uint32_t maybe = bits_of(nearer) & wanted;
            if (maybe == 0) continue;
            const std::uint32_t lanes = spans.changed(solid, i, t) & maybe;
            if (lanes == 0) continue;
            const LaneMask<double> better = lanes_of_bits<double>(lanes);
            best = select_lanes(better, t, best);
            const auto leaf = static_cast<double>(solid.leaves[spans.place[i]].id);
            best_leaf = select_lanes(better, Doubles(leaf), best_leaf);
            best_part = select_lanes(better, side == 0 ? of.entry_part : of.exit_part, best_part);
        }
    }
    store_lanes(best, hits.t);
    store_lanes(best_part, hits.part);
    store_lanes(best_leaf, hits.primitive);
    return wanted & bits_of(best < Doubles(kInfinity));
}

}  // namespace

const CsgLanesKernel& csg_lanes_of_target() {
    static constexpr CsgLanesKernel kKernel{&first, kFusesExactly};
    return kKernel;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(csg_lanes_of_target);

const CsgLanesKernel& csg_lanes_kernel() {
    return ALHAZEN_KERNEL(csg_lanes_of_target)();
}

}  // namespace alhazen
#endif
