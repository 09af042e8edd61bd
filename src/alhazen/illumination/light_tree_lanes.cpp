#include "alhazen/illumination/light_tree_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/illumination/light_tree_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <algorithm>

#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace light_choices {

using Siblings = LightTree::Siblings;

/// Both siblings of two pairs: lanes 0 and 1 belong to one point, 2 and 3 to another.
using Numbers = Lanes<double, 4>;
using Mask = LaneMask<double, 4>;

template <std::size_t N = 4>
HWY_INLINE Lanes<double, N> joined(const double (&a)[2], const double (&b)[2]) {
    Lanes<double, N> r;
    const LaneTag<double, N> tag;
#if HWY_TARGET != HWY_SCALAR
    if constexpr (kParts<double, N> == 1) {
        const hn::Half<LaneTag<double, N>> half;
        r.part[0] = hn::Combine(tag, hn::LoadU(half, b), hn::LoadU(half, a));
        return r;
    }
#endif
    constexpr std::size_t kHere = kParts<double, N> / 2;
    for (std::size_t i = 0; i < kHere; ++i) {
        r.part[i] = hn::LoadU(tag, a + i * hn::Lanes(tag));
        r.part[kHere + i] = hn::LoadU(tag, b + i * hn::Lanes(tag));
    }
    return r;
}
/// Each lane of a point becomes the other.
HWY_INLINE Numbers swapped(const Numbers& a) {
    Numbers r;
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t i = 0; i < 4; ++i) r.part[i] = a.part[i ^ 1];
#else
    for (std::size_t i = 0; i < kParts<double, 4>; ++i) r.part[i] = hn::Shuffle01(a.part[i]);
#endif
    return r;
}
/// Two successive numbers of Siblings, as `joined`.
struct TwoNumbers {
    Numbers first, second;
};
HWY_INLINE TwoNumbers joined_floats(const float* a, const float* b) {
#if HWY_TARGET == HWY_SCALAR
    TwoNumbers r;
    for (std::size_t i = 0; i < 4; ++i) {
        const float* from = i < 2 ? a + i : b + (i - 2);
        r.first.part[i] = hn::Set(LaneTag<double, 4>(), double{from[0]});
        r.second.part[i] = hn::Set(LaneTag<double, 4>(), double{from[2]});
    }
    return r;
#else
    const LaneTag<float, 4> tag;
    const auto of_a = hn::LoadU(tag, a), of_b = hn::LoadU(tag, b);
    Lanes<float, 4> first, second;
    first.part[0] = hn::ConcatLowerLower(tag, of_b, of_a);
    second.part[0] = hn::ConcatUpperUpper(tag, of_b, of_a);
    return {as_doubles(first), as_doubles(second)};
#endif
}

/// std::max(b, a) and std::min(b, a) of each lane: a NaN in `a` gives `b`.
HWY_INLINE Numbers larger_of(const Numbers& a, const Numbers& b) {
    return select_lanes(a > b, a, b);
}
HWY_INLINE Numbers smaller_of(const Numbers& a, const Numbers& b) {
    return select_lanes(a < b, a, b);
}
HWY_INLINE Numbers clamped_cosine(const Numbers& x) {
    return smaller_of(Numbers(1.0), larger_of(Numbers(-1.0), x));
}
HWY_INLINE Numbers sine_of(const Numbers& cosine) {
    return sqrt(larger_of(Numbers(1.0) - cosine * cosine, Numbers(0.0)));
}
/// The cosine and the sine of max(0, a - b) for angles a and b.
HWY_INLINE Numbers cosine_of_difference(const Numbers& cosine_a, const Numbers& sine_a,
                                        const Numbers& cosine_b, const Numbers& sine_b) {
    return select_lanes(cosine_a > cosine_b, Numbers(1.0), cosine_a * cosine_b + sine_a * sine_b);
}
HWY_INLINE Numbers sine_of_difference(const Numbers& cosine_a, const Numbers& sine_a,
                                      const Numbers& cosine_b, const Numbers& sine_b) {
    return select_lanes(cosine_a > cosine_b, Numbers(0.0), sine_a * cosine_b - cosine_a * sine_b);
}

/// A point on its way down the tree.
struct Walker {
    alignas(16) double point[3][2], normal[3][2];  ///< each number twice
    double choice;
    double probability = 1.0;
    std::uint32_t pair;                   ///< whose siblings are next
    std::uint32_t place;                  ///< number of the point
    std::uint32_t both_sides, in_volume;  ///< bits of two lanes
};

/// `importance` (light_importance.h) of both siblings of each point, operation by operation.
HWY_INLINE Numbers importances_of(const Siblings& n, const Siblings& m, const Walker& v,
                                  const Walker& w) {
    const auto [axis_x, axis_y] = joined_floats(n.axis[0], m.axis[0]);
    const auto [axis_z, spread] = joined_floats(n.axis[2], m.axis[2]);
    const auto [reach, signed_intensity] = joined_floats(n.cosine_reach, m.cosine_reach);
    const Numbers one(1.0), zero(0.0);
    const Numbers x = joined(n.center[0], m.center[0]) - joined(v.point[0], w.point[0]);
    const Numbers y = joined(n.center[1], m.center[1]) - joined(v.point[1], w.point[1]);
    const Numbers z = joined(n.center[2], m.center[2]) - joined(v.point[2], w.point[2]);
    const Numbers radius2 = joined(n.radius2, m.radius2), true_squared = x * x + y * y + z * z;
    const Numbers intensity = abs(signed_intensity);
    const Mask in_volume = lanes_of_bits<double, 4>(v.in_volume | w.in_volume << 2);
    const Mask both_sides = lanes_of_bits<double, 4>(v.both_sides | w.both_sides << 2);
    // Inside the sphere around the node all directions are possible.
    const Mask outside = true_squared > radius2;
    const Numbers squared = select_lanes(outside, true_squared, one);
    const Numbers distance = sqrt(squared);
    const Numbers to_x = x / distance, to_y = y / distance, to_z = z / distance;
    const Numbers sine_b = smaller_of(joined(n.radius, m.radius) / distance, one);
    const Numbers cosine_b = sqrt(one - sine_b * sine_b);

    Numbers cosine_w = -(axis_x * to_x + axis_y * to_y + axis_z * to_z);
    cosine_w = clamped_cosine(select_lanes(signed_intensity < zero, abs(cosine_w), cosine_w));
    Numbers cosine_x = one, sine_x = zero;
    if (bits_of((!(cosine_w > spread)) & outside) != 0) {
        const Numbers sine_w = sine_of(cosine_w), sine_o = sine_of(spread);
        cosine_x = cosine_of_difference(cosine_w, sine_w, spread, sine_o);
        sine_x = sine_of_difference(cosine_w, sine_w, spread, sine_o);
    }
    const Numbers cosine_out = cosine_of_difference(cosine_x, sine_x, cosine_b, sine_b);
    // Lights other than surfaces have no cosine.
    const Numbers sent = intensity * select_lanes(reach < zero, one, cosine_out);

    const Numbers normal_x = joined(v.normal[0], w.normal[0]);
    const Numbers normal_y = joined(v.normal[1], w.normal[1]);
    const Numbers normal_z = joined(v.normal[2], w.normal[2]);
    Numbers cosine_i = normal_x * to_x + normal_y * to_y + normal_z * to_z;
    cosine_i = clamped_cosine(select_lanes(both_sides, abs(cosine_i), cosine_i));
    const Numbers received = cosine_of_difference(cosine_i, sine_of(cosine_i), cosine_b, sine_b);
    const Mask arrives = in_volume | (received > zero);
    const Mask leaves = !(cosine_out <= reach);
    Numbers result = select_lanes(in_volume, sent, sent * received) / squared;
    result = select_lanes(leaves & arrives, result, zero);
    if (bits_of(outside) == 15u) return result;
    return select_lanes(outside, result, intensity / larger_of(Numbers(1e-300), radius2));
}

/// Takes two points one step down the tree, or one if they are the same. Those that go on are
/// written to `going`, which is moved behind them.
HWY_INLINE void descend(const LightTree& tree, Walker& v, Walker& w, Walker**& going,
                        ChosenLight* chosen) {
    const Siblings* const pairs = tree.pairs().data();
    const LightTree::Link* const links = tree.links().data();
    const Numbers own = importances_of(pairs[v.pair], pairs[w.pair], v, w);
    const Numbers sum = own + swapped(own), one(1.0);
    const Mask is_lit = sum > Numbers(0.0);
    // No division of 0 by 0.
    HWY_ALIGN double shares[4];
    store_lanes(own / select_lanes(is_lit, sum, one), shares);
    const std::uint32_t lit = bits_of(is_lit);
    const std::size_t count = &v == &w ? 1 : 2;
    for (std::size_t i = 0; i < count; ++i) {
        Walker& at = i == 0 ? v : w;
        const double part = shares[2 * i];
        // Without branches: the choice is not predictable.
        const std::size_t side = at.choice < part ? 0 : 1;
        const double below[2] = {0.0, part}, size[2] = {part, 1.0 - part};
        at.probability *= shares[2 * i + side];
        const LightTree::Link link = links[2 * at.pair + side];
        if ((lit >> 2 * i & 1u) == 0) {
            chosen[at.place] = {};
        } else if (link.is_leaf()) {
            chosen[at.place] = {link.target(), at.probability};
        } else {
            const double rest = (at.choice - below[side]) / size[side];
            at.choice = std::min(rest, 0x1.fffffffffffffp-1);
            at.pair = link.target();
            // It is read after a step of the other points.
            const auto* const next = reinterpret_cast<const char*>(pairs + at.pair);
            __builtin_prefetch(next);
            __builtin_prefetch(next + 64);
            __builtin_prefetch(links + 2 * std::size_t{at.pair});
            *going++ = &at;
        }
    }
}

inline void choose(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen) {
    Walker walkers[LitPointLanes::kMost];
    Walker* left[LitPointLanes::kMost];
    for (std::size_t i = 0; i < count; ++i) {
        Walker& w = walkers[i];
        for (int k = 0; k < 3; ++k) {
            w.point[k][0] = w.point[k][1] = at.point[k][i];
            w.normal[k][0] = w.normal[k][1] = at.normal[k][i];
        }
        w.choice = choices.of[i];
        w.pair = tree.root().target();
        w.place = static_cast<std::uint32_t>(i);
        w.both_sides = (at.both_sides >> i & 1u) * 3u;
        w.in_volume = (at.in_volume >> i & 1u) * 3u;
        left[i] = &w;
    }
    while (count > 0) {
        Walker** going = left;
        for (std::size_t i = 0; i < count; i += 2) {
            descend(tree, *left[i], *left[std::min(i + 1, count - 1)], going, chosen);
        }
        count = static_cast<std::size_t>(going - left);
    }
}

}  // namespace light_choices

void choose_lights_of_target(const LightTree& tree, const LitPointLanes& at,
                             const ChoiceLanes& choices, std::size_t count, ChosenLight* chosen) {
    light_choices::choose(tree, at, choices, count, chosen);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(choose_lights_of_target);

void choose_lights(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen) {
    if (tree.empty() || tree.root().is_leaf()) {
        // None, or one for all points.
        const ChosenLight only =
            tree.empty() ? ChosenLight{} : ChosenLight{tree.root().target(), 1.0};
        for (std::size_t i = 0; i < count; ++i) chosen[i] = only;
    } else if (count == 1) {
        chosen[0] = tree.choose(at[0], choices.of[0]);
    } else {
        ALHAZEN_KERNEL(choose_lights_of_target)(tree, at, choices, count, chosen);
    }
}

}  // namespace alhazen
#endif
