#include "alhazen/illumination/light_tree_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/illumination/light_tree_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace light_choices {

using Node = LightTree::Node;

/// std::max(b, a) and std::min(b, a) of each lane: a NaN in `a` gives `b`.
HWY_INLINE Doubles larger_of(const Doubles& a, const Doubles& b) {
    return select_lanes(a > b, a, b);
}
HWY_INLINE Doubles smaller_of(const Doubles& a, const Doubles& b) {
    return select_lanes(a < b, a, b);
}
HWY_INLINE Doubles clamped_cosine(const Doubles& x) {
    return smaller_of(Doubles(1.0), larger_of(Doubles(-1.0), x));
}
HWY_INLINE Doubles sine_of(const Doubles& cosine) {
    return sqrt(larger_of(Doubles(1.0) - cosine * cosine, Doubles(0.0)));
}
/// The cosine and the sine of max(0, a - b) for angles a and b.
HWY_INLINE Doubles cosine_of_difference(const Doubles& cosine_a, const Doubles& sine_a,
                                        const Doubles& cosine_b, const Doubles& sine_b) {
    return select_lanes(cosine_a > cosine_b, Doubles(1.0), cosine_a * cosine_b + sine_a * sine_b);
}
HWY_INLINE Doubles sine_of_difference(const Doubles& cosine_a, const Doubles& sine_a,
                                      const Doubles& cosine_b, const Doubles& sine_b) {
    return select_lanes(cosine_a > cosine_b, Doubles(0.0), sine_a * cosine_b - cosine_a * sine_b);
}

/// Numbers 4 k to 4 k + 3 of the first twelve of eight nodes, in lanes.
HWY_INLINE void load_numbers(const Node* const (&nodes)[kLaneCount], int k, Doubles (&numbers)[4]) {
    constexpr std::size_t kHalf = kLaneCount / 2;
#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to interleave
    const LaneTag<float, 4> tag;
    ALHAZEN_UNROLL
    for (std::size_t half = 0; half < 2; ++half) {
        const Node* const* const node = nodes + half * kHalf;
        const auto row = [&](std::size_t i) { return hn::LoadU(tag, node[i]->lo + 4 * k); };
        const auto a = row(0), b = row(1), c = row(2), d = row(3);
        const auto ab = hn::InterleaveLower(tag, a, b), cd = hn::InterleaveLower(tag, c, d);
        const auto ab2 = hn::InterleaveUpper(tag, a, b), cd2 = hn::InterleaveUpper(tag, c, d);
        Lanes<float, 4> columns[4];
        columns[0].part[0] = hn::ConcatLowerLower(tag, cd, ab);
        columns[1].part[0] = hn::ConcatUpperUpper(tag, cd, ab);
        columns[2].part[0] = hn::ConcatLowerLower(tag, cd2, ab2);
        columns[3].part[0] = hn::ConcatUpperUpper(tag, cd2, ab2);
        ALHAZEN_UNROLL
        for (int i = 0; i < 4; ++i) {
            const Lanes<double, 4> column = as_doubles(columns[i]);
            constexpr std::size_t kHere = kParts<double, 4>;
            for (std::size_t p = 0; p < kHere; ++p) {
                numbers[i].part[half * kHere + p] = column.part[p];
            }
        }
    }
#else
    HWY_ALIGN double lanes[kLaneCount];
    for (int i = 0; i < 4; ++i) {
        for (std::size_t lane = 0; lane < 2 * kHalf; ++lane) {
            lanes[lane] = nodes[lane]->lo[4 * k + i];
        }
        numbers[i] = load_lanes(lanes);
    }
#endif
}

/// The points, in lanes.
struct LitPoints {
    Doubles x, y, z, normal_x, normal_y, normal_z;
    LaneMask<double> both_sides, in_volume;
};

/// `importance` (light_importance.h) of a node for each point, operation by operation.
HWY_INLINE Doubles importances_of(const Node* const (&nodes)[kLaneCount], std::uint32_t two_sided,
                                  const LitPoints& at) {
    Doubles of[12];
    ALHAZEN_UNROLL
    for (int k = 0; k < 3; ++k) {
        Doubles numbers[4];
        load_numbers(nodes, k, numbers);
        ALHAZEN_UNROLL
        for (int i = 0; i < 4; ++i) of[4 * k + i] = numbers[i];
    }
    const auto& [lo_x, lo_y, lo_z, hi_x, hi_y, hi_z, axis_x, axis_y, axis_z, spread, reach,
                 intensity] = of;
    const Doubles half(0.5), one(1.0), zero(0.0);
    const Doubles x = half * (lo_x + hi_x) - at.x, y = half * (lo_y + hi_y) - at.y;
    const Doubles z = half * (lo_z + hi_z) - at.z;
    const Doubles size_x = hi_x - lo_x, size_y = hi_y - lo_y, size_z = hi_z - lo_z;
    const Doubles radius2 = Doubles(0.25) * (size_x * size_x + size_y * size_y + size_z * size_z);
    const Doubles true_squared = x * x + y * y + z * z;
    // Inside the sphere around the node all directions are possible.
    const LaneMask<double> outside = true_squared > radius2;
    const Doubles squared = select_lanes(outside, true_squared, one);
    const Doubles distance = sqrt(squared);
    const Doubles to_x = x / distance, to_y = y / distance, to_z = z / distance;
    const Doubles sine_b = smaller_of(sqrt(radius2) / distance, one);
    const Doubles cosine_b = sqrt(one - sine_b * sine_b);

    Doubles cosine_w = -(axis_x * to_x + axis_y * to_y + axis_z * to_z);
    cosine_w =
        clamped_cosine(select_lanes(lanes_of_bits<double>(two_sided), abs(cosine_w), cosine_w));
    const Doubles sine_w = sine_of(cosine_w), sine_o = sine_of(spread);
    const Doubles cosine_x = cosine_of_difference(cosine_w, sine_w, spread, sine_o);
    const Doubles sine_x = sine_of_difference(cosine_w, sine_w, spread, sine_o);
    const Doubles cosine_out = cosine_of_difference(cosine_x, sine_x, cosine_b, sine_b);
    // Lights other than surfaces have no cosine.
    const Doubles sent = intensity * select_lanes(reach < zero, one, cosine_out);

    Doubles cosine_i = at.normal_x * to_x + at.normal_y * to_y + at.normal_z * to_z;
    cosine_i = clamped_cosine(select_lanes(at.both_sides, abs(cosine_i), cosine_i));
    const Doubles received = cosine_of_difference(cosine_i, sine_of(cosine_i), cosine_b, sine_b);
    const LaneMask<double> arrives = at.in_volume | (received > zero);
    const LaneMask<double> leaves = !(cosine_out <= reach);
    Doubles result = select_lanes(at.in_volume, sent, sent * received) / squared;
    result = select_lanes(leaves & arrives, result, zero);
    if (bits_of(outside) == kAllLanes) return result;
    return select_lanes(outside, result, intensity / larger_of(Doubles(1e-300), radius2));
}

inline void choose(const LightTree& tree, const LitPointLanes& points, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen) {
    const Node* const nodes = tree.nodes().data();
    // Lanes without a point, and those that are done, stay at the root.
    const Node* node[kLaneCount];
    HWY_ALIGN double share[kLaneCount];
    for (std::size_t i = 0; i < kLaneCount; ++i) node[i] = nodes;
    const LitPoints at{load_lanes(points.point[0]),
                       load_lanes(points.point[1]),
                       load_lanes(points.point[2]),
                       load_lanes(points.normal[0]),
                       load_lanes(points.normal[1]),
                       load_lanes(points.normal[2]),
                       lanes_of_bits<double>(points.both_sides),
                       lanes_of_bits<double>(points.in_volume)};
    Doubles choice = load_lanes(choices.of), probability(1.0);
    const Doubles one(1.0), most(0x1.fffffffffffffp-1);
    for (std::uint32_t left = (1u << count) - 1;;) {
        const Node *first[kLaneCount], *second[kLaneCount];
        std::uint32_t first_two_sided = 0, second_two_sided = 0;
        for (std::size_t i = 0; i < kLaneCount; ++i) {
            first[i] = nodes + node[i]->content;
            second[i] = first[i] + 1;
            first_two_sided |= std::uint32_t{first[i]->two_sided} << i;
            second_two_sided |= std::uint32_t{second[i]->two_sided} << i;
        }
        const Doubles one_importance = importances_of(first, first_two_sided, at);
        const Doubles other = importances_of(second, second_two_sided, at);
        const Doubles both = one_importance + other;
        const LaneMask<double> is_lit_lane = both > Doubles(0.0);
        const std::uint32_t lit = bits_of(is_lit_lane);
        // No division of 0 by 0.
        const Doubles sum = select_lanes(is_lit_lane, both, one), part = one_importance / sum;
        const LaneMask<double> takes_first = choice < part;
        choice = select_lanes(takes_first, choice, choice - part) /
                 select_lanes(takes_first, part, one - part);
        choice = smaller_of(most, choice);
        probability = probability * select_lanes(takes_first, part, other / sum);
        store_lanes(probability, share);
        const std::uint32_t taken = bits_of(takes_first);
        for (std::uint32_t lanes = left; lanes != 0; lanes &= lanes - 1) {
            const int i = std::countr_zero(lanes);
            node[i] = (taken >> i & 1u) != 0 ? first[i] : second[i];
            const bool is_lit = (lit >> i & 1u) != 0;
            if (is_lit && !node[i]->leaf) continue;
            chosen[i] = is_lit ? ChosenLight{node[i]->content, share[i]} : ChosenLight{};
            node[i] = nodes;
            left &= ~(1u << i);
        }
        if (left == 0) return;
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
    const std::vector<LightTree::Node>& nodes = tree.nodes();
    if (nodes.size() <= 1) {
        // None, or one for all points.
        const ChosenLight only = nodes.empty() ? ChosenLight{} : ChosenLight{nodes[0].content, 1.0};
        for (std::size_t i = 0; i < count; ++i) chosen[i] = only;
    } else if (count == 1) {
        chosen[0] = tree.choose(at[0], choices.of[0]);
    } else {
        ALHAZEN_KERNEL(choose_lights_of_target)(tree, at, choices, count, chosen);
    }
}

}  // namespace alhazen
#endif
