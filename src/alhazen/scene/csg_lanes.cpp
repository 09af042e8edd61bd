#include "alhazen/scene/csg_lanes.h"

#include <limits>

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/scene/csg_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

static_assert(kRayLanes == kLaneCount);

constexpr std::uint32_t kMaxLeaves = CsgLanesSolid::kMaxLeaves;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The spans of the leaves that some ray meets.
struct Spans {
    std::uint32_t count = 0;
    std::uint32_t leaf[kMaxLeaves];
    std::uint32_t met[kMaxLeaves];
    Doubles entry[kMaxLeaves], exit[kMaxLeaves];  ///< an empty span where the ray misses

    HWY_INLINE void add(std::uint32_t number, const SpanLanes& spans, std::uint32_t wanted) {
        const std::uint32_t lanes = spans.met & wanted;
        if (lanes == 0) return;
        const LaneMask<double> mask = lanes_of_bits<double>(lanes);
        leaf[count] = number;
        met[count] = lanes;
        entry[count] = select_lanes(mask, load_lanes(spans.entry), Doubles(kInfinite));
        exit[count] = select_lanes(mask, load_lanes(spans.exit), Doubles(-kInfinite));
        ++count;
    }
    /// The rays of which two crossings lie closer than `apart`.
    [[nodiscard]] HWY_INLINE std::uint32_t close(const Doubles& apart) const {
        const auto near = [&](const Doubles& a, const Doubles& b)
                              HWY_ATTR { return abs(a - b) < apart; };
        std::uint32_t lanes = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            LaneMask<double> found = near(entry[i], exit[i]);
            for (std::uint32_t j = 0; j < i; ++j) {
                found = found | near(entry[i], entry[j]) | near(entry[i], exit[j]) |
                        near(exit[i], entry[j]) | near(exit[i], exit[j]);
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
            if (j != i) inside[leaf[j]] = bits_of((entry[j] < t) & (t < exit[j]));
        }
        std::uint32_t lanes = 0;
        for (std::uint64_t rest = solid.changes[leaf[i]]; rest != 0; rest &= rest - 1) {
            const auto set = static_cast<std::uint32_t>(__builtin_ctzll(rest));
            std::uint32_t there = met[i];
            for (std::uint32_t k = 0; k < solid.leaf_count; ++k) {
                there &= (set >> k & 1) != 0 ? inside[k] : ~inside[k];
            }
            lanes |= there;
        }
        return lanes;
    }
};

HWY_INLINE Doubles largest(const Doubles& x, const Doubles& y, const Doubles& z) {
    return max_lanes(max_lanes(abs(x), abs(y)), abs(z));
}

/// How far crossings must lie apart along the rays.
HWY_INLINE Doubles apart_along(const CsgLanesSolid& solid, const RayLanes& rays) {
    const Doubles away = largest(load_lanes(rays.origin[0]) - Doubles(solid.center.x),
                                 load_lanes(rays.origin[1]) - Doubles(solid.center.y),
                                 load_lanes(rays.origin[2]) - Doubles(solid.center.z));
    const Doubles speed = largest(load_lanes(rays.direction[0]), load_lanes(rays.direction[1]),
                                  load_lanes(rays.direction[2]));
    return Doubles(solid.apart) * (Doubles(solid.size) + away) / speed;
}

std::uint32_t in_range(const CsgLanesSolid& solid, const RayLanes& rays, const SpanLanes& spans,
                       std::uint32_t wanted) {
    const std::uint32_t met = spans.met & wanted;
    if (met == 0) return spans.unsure & wanted;
    // What lies a little behind the end may be one with a crossing in front of it.
    const Doubles end = load_lanes(rays.t_max) + apart_along(solid, rays);
    return (met & bits_of((load_lanes(spans.entry) <= end) &
                          (load_lanes(spans.exit) >= load_lanes(rays.t_min)))) |
           (spans.unsure & wanted);
}

void first(const CsgLanesSolid& solid, const RayLanes& rays, const SpanLanes* all,
           std::uint32_t wanted, CsgLanesHits& out) {
    Spans spans;
    out.unsure = 0;
    for (std::uint32_t i = 0; i < solid.leaf_count; ++i) {
        out.unsure |= all[i].unsure & wanted;
        spans.add(i, all[i], wanted);
    }
    out.unsure |= spans.close(apart_along(solid, rays)) & wanted;
    wanted &= ~out.unsure;
    const Doubles t_min = load_lanes(rays.t_min), t_max = load_lanes(rays.t_max);
    Doubles best(kInfinite), event(0.0);
    for (std::uint32_t i = 0; i < spans.count; ++i) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const Doubles t = side == 0 ? spans.entry[i] : spans.exit[i];
            const std::uint32_t lanes = spans.changed(solid, i, t) & wanted;
            if (lanes == 0) continue;
            const LaneMask<double> better =
                lanes_of_bits<double>(lanes) & (t >= t_min) & (t <= t_max) & (t < best);
            best = select_lanes(better, t, best);
            event = select_lanes(better, Doubles(double(2 * spans.leaf[i] + side)), event);
        }
    }
    out.hit = wanted & bits_of(best < Doubles(kInfinite));
    store_lanes(best, out.t);
    store_lanes(event, out.event);
}

}  // namespace

const CsgLanesKernels& csg_lanes_of_target() {
    static constexpr CsgLanesKernels kKernels{&in_range, &first};
    return kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(csg_lanes_of_target);

const CsgLanesKernels& csg_lanes_kernels() {
    // Asked for every eight rays: what the processor can do is not looked up again.
    return HWY_DYNAMIC_DISPATCH(csg_lanes_of_target)();
}

}  // namespace alhazen
#endif
