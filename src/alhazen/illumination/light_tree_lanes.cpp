#include "alhazen/illumination/light_tree_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/illumination/light_tree_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "alhazen/illumination/light_importance.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace light_choices {

#if HWY_TARGET == HWY_SCALAR || HWY_MAX_BYTES < 32

inline void choose(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen, const LightRecord* /*lights*/) {
    for (std::size_t i = 0; i < count; ++i) chosen[i] = tree.choose(at[i], choices.of[i]);
}

#else

using Node = LightTree::Node;

/// The children of the nodes of several points: lanes 4 i to 4 i + 3 of a register belong to point
/// i of a half, those of the other half are in a second register. Doubles and words have a lane for
/// each point of both.
using FloatTag = hn::CappedTag<float, 16>;
constexpr std::size_t kWidth = LightTree::kWidth;
constexpr std::size_t kLanes = hn::MaxLanes(FloatTag()), kHalf = kLanes / kWidth;
constexpr std::size_t kPoints = 2 * kHalf;
using HalfFloats = hn::Half<FloatTag>;
using DoubleTag = hn::Rebind<double, HalfFloats>;
using WordTag = hn::RebindToUnsigned<DoubleTag>;
using IntegerTag = hn::RebindToSigned<FloatTag>;
using Integers = hn::Vec<IntegerTag>;
using Numbers = Lanes<float, kLanes>;
using Mask = LaneMask<float, kLanes>;

/// The bit of a link to a light, and the link to light 0.
const std::uint64_t kLeafBit = LightTree::Link::to_light(0).bits();

static_assert(sizeof(Node) == 128 && offsetof(Node, links) == 112);

/// Points on their way down the tree.
struct Walkers {
    alignas(64) float point[2][3][kLanes], normal[2][3][kLanes];  ///< [half]
    std::uint32_t both_sides[2] = {}, in_volume[2] = {};          ///< [half] bits of lanes
    /// `rest`: of the choice, less than `probability`.
    alignas(64) double rest[kPoints], probability[kPoints];
    alignas(64) const Node* nodes[kPoints];    ///< whose children are next
    alignas(64) std::uint64_t links[kPoints];  ///< LightTree::Link, taken last
    bool walk = false;                         ///< some links lead to nodes
};

/// Stores the doubles as floats, each in the lanes of its point.
HWY_INLINE void store_repeated(hn::Vec<DoubleTag> a, float* low, float* high) {
    HWY_ALIGN std::int32_t places[2][kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) {
        places[0][i] = static_cast<std::int32_t>(i / kWidth);
        places[1][i] = static_cast<std::int32_t>(kHalf + i / kWidth);
    }
    const FloatTag tag;
    const auto once = hn::ZeroExtendVector(tag, hn::DemoteTo(HalfFloats(), a));
    hn::Store(hn::TableLookupLanes(once, hn::SetTableIndices(tag, places[0])), tag, low);
    hn::Store(hn::TableLookupLanes(once, hn::SetTableIndices(tag, places[1])), tag, high);
}

/// Sets the points to those from `first` on, as PointOfTree does.
HWY_INLINE void set_points(const LightTree& tree, const LitPointLanes& at, std::size_t first,
                           Walkers& w) {
    const DoubleTag tag;
    const auto scale = hn::Set(tag, tree.scale());
    hn::Vec<DoubleTag> place[3];
    auto most = hn::Zero(tag);
    for (int k = 0; k < 3; ++k) {
        const auto offset =
            hn::Sub(hn::Load(tag, at.point[k] + first), hn::Set(tag, tree.origin()[k]));
        place[k] = hn::Mul(offset, scale);
        most = hn::Max(hn::Abs(place[k]), most);
    }
    const auto far = hn::Set(tag, kFarFromLights), one = hn::Set(tag, 1.0);
    const auto is_far = hn::Gt(most, far);
    const auto nearer = hn::IfThenElse(is_far, hn::Div(far, hn::Max(most, one)), one);
    for (int k = 0; k < 3; ++k) {
        store_repeated(hn::Mul(place[k], nearer), w.point[0][k], w.point[1][k]);
        store_repeated(hn::Load(tag, at.normal[k] + first), w.normal[0][k], w.normal[1][k]);
    }
    if ((at.both_sides | at.in_volume) == 0) return;
    for (std::size_t lane = 0; lane < 2 * kLanes; ++lane) {
        const std::size_t half = lane / kLanes, point = first + lane / kWidth;
        w.both_sides[half] |= (at.both_sides >> point & 1u) << lane % kLanes;
        w.in_volume[half] |= (at.in_volume >> point & 1u) << lane % kLanes;
    }
}

/// A member of the children of some points, of 4 bytes; `place` counts members.
template <class Tag>
HWY_INLINE hn::Vec<Tag> member_of(Tag tag, const Node* const* nodes, std::size_t place) {
    constexpr std::size_t kNodes = hn::MaxLanes(tag) / kWidth;
    if constexpr (kNodes == 1) {
        return hn::Load(tag, reinterpret_cast<const hn::TFromD<Tag>*>(nodes[0]) + kWidth * place);
    } else {
        const hn::Half<Tag> half;
        return hn::Combine(tag, member_of(half, nodes + kNodes / 2, place),
                           member_of(half, nodes, place));
    }
}
HWY_INLINE Numbers numbers_of(const Node* const* nodes, std::size_t place) {
    Numbers r;
    r.part[0] = member_of(FloatTag(), nodes, place);
    return r;
}
/// The lower and the upper half of each integer, as signed numbers.
HWY_INLINE Numbers lower_numbers(Integers of) {
    Numbers r;
    r.part[0] = hn::ConvertTo(FloatTag(), hn::ShiftRight<16>(hn::ShiftLeft<16>(of)));
    return r;
}
HWY_INLINE Numbers upper_numbers(Integers of) {
    Numbers r;
    r.part[0] = hn::ConvertTo(FloatTag(), hn::ShiftRight<16>(of));
    return r;
}

/// `importances` (light_importance.h) of the children of each point of a half, operation by
/// operation.
/// `kSimple`: all points count light of one side.
template <bool kSimple>
HWY_INLINE Numbers importances_of(const Walkers& w, std::size_t half) {
    const Node* const* const nodes = w.nodes + half * kHalf;
    constexpr float kUnit = 1.0f / LightTree::kAxisUnits;
    const auto point = [&](std::size_t k) HWY_ATTR { return load_lanes<kLanes>(w.point[half][k]); };
    const auto normal = [&](std::size_t k)
                            HWY_ATTR { return load_lanes<kLanes>(w.normal[half][k]); };
    const Numbers zero(0.0f);
    const Numbers x = numbers_of(nodes, 0) - point(0), y = numbers_of(nodes, 1) - point(1),
                  z = numbers_of(nodes, 2) - point(2);
    const Numbers squared = x * x + y * y + z * z, variance = numbers_of(nodes, 3);
    const Integers intensities = member_of(IntegerTag(), nodes, 4);
    constexpr auto kIntensityMask = static_cast<std::int32_t>(LightTree::kIntensityMask);
    Numbers intensity, turn;
    intensity.part[0] =
        hn::BitCast(FloatTag(), hn::And(intensities, hn::Set(IntegerTag(), kIntensityMask)));
    turn.part[0] = hn::BitCast(FloatTag(), hn::ShiftLeft<32 - LightTree::kTurnBits>(intensities));
    const Integers axes_xy = member_of(IntegerTag(), nodes, 5);
    const Integers axes_z = member_of(IntegerTag(), nodes, 6);
    const Numbers axis_x = lower_numbers(axes_xy), axis_y = upper_numbers(axes_xy);
    const Numbers axis_z = lower_numbers(axes_z);
    Numbers radius2;
    radius2.part[0] =
        hn::BitCast(FloatTag(), hn::And(axes_z, hn::Set(IntegerTag(), std::int32_t{-0x10000})));

    const Numbers along = (axis_x * x + axis_y * y + axis_z * z) * Numbers(-kUnit);
    const Numbers sent_root = sqrt(along * along + turn * squared + variance);
    const Numbers sent = sent_root + select_lanes(intensity < zero, sent_root, along);

    const Numbers height = normal(0) * x + normal(1) * y + normal(2) * z;
    const Numbers grazing = Numbers(kGrazing) * squared, height2 = height * height;
    const Numbers received_root = sqrt(height2 + (variance + grazing));
    const Numbers spread = squared + variance;
    Numbers received = received_root + height;
    Mask dark = (height < zero) & (height2 >= radius2 + grazing);
    if (!kSimple) {
        const Mask in_volume = lanes_of_bits<float, kLanes>(w.in_volume[half]);
        const Mask both_sides = lanes_of_bits<float, kLanes>(w.both_sides[half]);
        received = received_root + select_lanes(both_sides, received_root, height);
        received = select_lanes(in_volume, Numbers(2.0f) * sqrt(spread), received);
        dark = dark & !(in_volume | both_sides);
    }
    const Numbers importance = abs(intensity) * sent * received / (spread * spread);
    return select_lanes(dark, zero, importance);
}

/// Importances of the children of all points, [child], from those of both halves.
struct Importances {
    hn::Vec<DoubleTag> of[kWidth];
};
HWY_INLINE hn::Vec<DoubleTag> promoted(hn::Vec<FloatTag> a) {
    return hn::PromoteTo(DoubleTag(), hn::LowerHalf(HalfFloats(), a));
}
HWY_INLINE Importances all_importances(hn::Vec<FloatTag> low, hn::Vec<FloatTag> high) {
    const FloatTag tag;
    const auto even = hn::ConcatEven(tag, high, low), odd = hn::ConcatOdd(tag, high, low);
    return {{promoted(hn::ConcatEven(tag, even, even)), promoted(hn::ConcatEven(tag, odd, odd)),
             promoted(hn::ConcatOdd(tag, even, even)), promoted(hn::ConcatOdd(tag, odd, odd))}};
}
/// Links to the children of all points, [child].
struct Links {
    hn::Vec<WordTag> to[kWidth];
};
HWY_INLINE Links all_links(const Node* const* nodes) {
    const hn::RebindToUnsigned<FloatTag> tag;
    const WordTag words;
    constexpr std::size_t kPlace = offsetof(Node, links) / sizeof(Node::links);
    const auto low = member_of(tag, nodes, kPlace), high = member_of(tag, nodes + kHalf, kPlace);
    const auto even = hn::BitCast(words, hn::ConcatEven(tag, high, low));
    const auto odd = hn::BitCast(words, hn::ConcatOdd(tag, high, low));
    const auto lower = hn::Set(words, 0xFFFFFFFFu);
    return {{hn::And(even, lower), hn::And(odd, lower), hn::ShiftRight<32>(even),
             hn::ShiftRight<32>(odd)}};
}

/// One step down the tree for each point that has not ended. The others stay where they are:
/// without branches, as the end of a point is not predictable.
template <bool kSimple>
HWY_INLINE void descend(const LightTree& tree, const LightRecord* lights, Walkers& w) {
    const DoubleTag tag;
    const WordTag words;
    const auto low = importances_of<kSimple>(w, 0).part[0];
    const auto high = importances_of<kSimple>(w, 1).part[0];
    const Importances own = all_importances(low, high);
    const auto of0 = own.of[0], of1 = own.of[1], of2 = own.of[2], of3 = own.of[3];
    const auto two = hn::Add(of0, of1), three = hn::Add(two, of2), sum = hn::Add(three, of3);
    const auto zero = hn::Zero(tag), one = hn::Set(tag, 1.0);
    const auto is_lit = hn::Gt(sum, zero);
    const auto probability = hn::Load(tag, w.probability), rest = hn::Load(tag, w.rest);
    // What follows waits for no division.
    const auto at_rest = hn::Mul(rest, sum);
    const auto from1 = hn::Ge(at_rest, hn::Mul(probability, of0));
    const auto from2 = hn::And(from1, hn::Ge(at_rest, hn::Mul(probability, two)));
    const auto from3 = hn::And(from2, hn::Ge(at_rest, hn::Mul(probability, three)));
    const auto selected = [&](auto t, auto a, auto b, auto c, auto d) HWY_ATTR {
        const auto upper = hn::IfThenElse(hn::RebindMask(t, from3), d, c);
        const auto lower = hn::IfThenElse(hn::RebindMask(t, from1), b, a);
        return hn::IfThenElse(hn::RebindMask(t, from2), upper, lower);
    };
    const Links to = all_links(w.nodes);
    const auto next = selected(words, to.to[0], to.to[1], to.to[2], to.to[3]);

    const auto before = hn::Load(words, w.links);
    const auto leaf = hn::Set(words, kLeafBit);
    const auto walks = hn::Eq(hn::And(before, leaf), hn::Zero(words));
    const auto found = hn::IfThenElse(hn::RebindMask(words, is_lit), next, leaf);
    const auto links = hn::IfThenElse(walks, found, before);
    hn::Store(links, words, w.links);
    const auto walk_on = hn::Eq(hn::And(links, leaf), hn::Zero(words));
    w.walk = !hn::AllFalse(words, walk_on);
    static_assert(sizeof(Node*) == sizeof(std::uint64_t) && sizeof(LightRecord) == sizeof(Node));
    auto* const addresses = reinterpret_cast<std::uint64_t*>(w.nodes);
    const auto start = hn::Set(words, reinterpret_cast<std::uint64_t>(tree.nodes().data()));
    const auto there = hn::Add(start, hn::ShiftLeft<7>(links));
    hn::Store(hn::IfThenElse(walk_on, there, hn::Load(words, addresses)), words, addresses);
    // Of points that end, what is read of their lights.
    alignas(64) const char* fetched[kPoints];
    const auto light = hn::Add(hn::Set(words, reinterpret_cast<std::uint64_t>(lights)),
                               hn::ShiftLeft<7>(hn::AndNot(leaf, links)));
    hn::Store(hn::IfThenElse(walk_on, there, light), words,
              reinterpret_cast<std::uint64_t*>(fetched));
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kPoints; ++i) {
        __builtin_prefetch(fetched[i]);
        __builtin_prefetch(fetched[i] + 64);
    }

    // No division by 0.
    const auto part = hn::Div(one, hn::IfThenElse(is_lit, sum, one));
    const auto sum_before = selected(tag, zero, of0, two, three);
    const auto skipped = hn::Mul(probability, hn::Mul(sum_before, part));
    hn::Store(hn::Max(hn::Sub(rest, skipped), zero), tag, w.rest);
    const auto taken = hn::Mul(probability, hn::Mul(selected(tag, of0, of1, of2, of3), part));
    hn::Store(
        hn::IfThenElse(hn::RebindMask(tag, walks), hn::IfThenElseZero(is_lit, taken), probability),
        tag, w.probability);
}

HWY_INLINE void begin(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                      std::size_t first, std::size_t count, Walkers& w) {
    set_points(tree, at, first, w);
    for (std::size_t i = 0; i < kPoints; ++i) {
        w.rest[i] = choices.of[first + i];
        w.probability[i] = 1.0;
        w.nodes[i] = &tree.nodes()[tree.root().target()];
        w.links[i] = i < count ? tree.root().bits() : kLeafBit;
    }
    w.walk = true;
}

inline void choose(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen, const LightRecord* lights) {
    // While one group takes a step, the next nodes of the others are fetched.
    constexpr std::size_t kGroups = LitPointLanes::kMost / kPoints;
    Walkers groups[kGroups];
    std::size_t used = 0;
    for (std::size_t first = 0; first < count; first += kPoints) {
        begin(tree, at, choices, first, std::min(kPoints, count - first), groups[used++]);
    }
    // Addresses of nothing would be looked up in all tables of pages.
    if (lights == nullptr) lights = reinterpret_cast<const LightRecord*>(tree.nodes().data());
    const bool simple = (at.both_sides | at.in_volume) == 0;
    for (bool any = true; any;) {
        any = false;
        for (std::size_t k = 0; k < used; ++k) {
            if (!groups[k].walk) continue;
            if (simple) {
                descend<true>(tree, lights, groups[k]);
            } else {
                descend<false>(tree, lights, groups[k]);
            }
            any = any || groups[k].walk;
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Walkers& w = groups[i / kPoints];
        const auto link = static_cast<std::uint32_t>(w.links[i % kPoints]);
        chosen[i] = {LightTree::Link::of_bits(link).target(), w.probability[i % kPoints]};
    }
}

#endif

}  // namespace light_choices

void choose_lights_of_target(const LightTree& tree, const LitPointLanes& at,
                             const ChoiceLanes& choices, std::size_t count, ChosenLight* chosen,
                             const LightRecord* lights) {
    light_choices::choose(tree, at, choices, count, chosen, lights);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(choose_lights_of_target);

void choose_lights(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen, const LightRecord* lights) {
    if (tree.empty() || tree.root().is_leaf()) {
        // None, or one for all points.
        const ChosenLight only =
            tree.empty() ? ChosenLight{} : ChosenLight{tree.root().target(), 1.0};
        for (std::size_t i = 0; i < count; ++i) chosen[i] = only;
    } else if (count == 1 || !tree.cones().empty()) {
        for (std::size_t i = 0; i < count; ++i) chosen[i] = tree.choose(at[i], choices.of[i]);
    } else {
        ALHAZEN_KERNEL(choose_lights_of_target)(tree, at, choices, count, chosen, lights);
    }
}

}  // namespace alhazen
#endif
