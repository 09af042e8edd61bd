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

#if HWY_TARGET == HWY_SCALAR

inline void choose(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen, const LightRecord* /*lights*/) {
    for (std::size_t i = 0; i < count; ++i) chosen[i] = tree.choose(at[i], choices.of[i]);
}

#else

using Siblings = LightTree::Siblings;

/// Both siblings of several pairs: lanes 2 i and 2 i + 1 belong to point i, as does lane i of
/// doubles and words.
using FloatTag = hn::CappedTag<float, 16>;
constexpr std::size_t kLanes = hn::MaxLanes(FloatTag()), kPoints = kLanes / 2;
using DoubleTag = hn::Rebind<double, hn::Half<FloatTag> >;
using WordTag = hn::RebindToUnsigned<DoubleTag>;
using Words = hn::Vec<WordTag>;
using Numbers = Lanes<float, kLanes>;
using Mask = LaneMask<float, kLanes>;

/// The bit of a link to a light, and the link to light 0.
const std::uint64_t kLeafBit = LightTree::Link::to_light(0).bits();

static_assert(sizeof(Siblings) == 64 && offsetof(Siblings, variance) == 24 &&
              offsetof(Siblings, axis_xy) == 40 && offsetof(Siblings, links) == 56);

/// Points on their way down the tree.
struct Walkers {
    alignas(64) float point[3][kLanes], normal[3][kLanes];
    std::uint32_t both_sides = 0, in_volume = 0;  ///< bits of lanes
    /// `rest`: of the choice, less than `probability`.
    alignas(64) double rest[kPoints], probability[kPoints];
    alignas(64) const Siblings* pairs[kPoints];  ///< whose siblings are next
    alignas(64) std::uint64_t links[kPoints];    ///< LightTree::Link, taken last
    bool walk = false;                           ///< some links lead to siblings
};

/// The doubles as floats, each twice.
HWY_INLINE hn::Vec<FloatTag> twice(hn::Vec<DoubleTag> a) {
    const hn::Half<FloatTag> floats;
    const hn::RebindToUnsigned<hn::Half<FloatTag> > bits;
    const auto once = hn::PromoteTo(WordTag(), hn::BitCast(bits, hn::DemoteTo(floats, a)));
    return hn::BitCast(FloatTag(), hn::Or(once, hn::ShiftLeft<32>(once)));
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
        hn::Store(twice(hn::Mul(place[k], nearer)), FloatTag(), w.point[k]);
        hn::Store(twice(hn::Load(tag, at.normal[k] + first)), FloatTag(), w.normal[k]);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        w.both_sides |= (at.both_sides >> (first + lane / 2) & 1u) << lane;
        w.in_volume |= (at.in_volume >> (first + lane / 2) & 1u) << lane;
    }
}

/// A register of blocks of 16 bytes, of block `block` of each pair.
template <class Tag>
HWY_INLINE hn::Vec<Tag> blocks_of(Tag tag, const Siblings* const* pairs, std::size_t block) {
    constexpr std::size_t kBlocks = hn::MaxLanes(tag) / 2;
    if constexpr (kBlocks == 1) {
        return hn::Load(tag, reinterpret_cast<const std::uint64_t*>(pairs[0]) + 2 * block);
    } else {
        const hn::Half<Tag> half;
        return hn::Combine(tag, blocks_of(half, pairs + kBlocks / 2, block),
                           blocks_of(half, pairs, block));
    }
}
/// Two successive members of Siblings, each for both siblings of each point.
struct TwoMembers {
    Words first, second;
};
HWY_INLINE TwoMembers members_of(const Siblings* const* pairs, std::size_t block) {
    const WordTag tag;
    const auto low = blocks_of(tag, pairs, block);
    const auto high = blocks_of(tag, pairs + kPoints / 2, block);
    return {hn::ConcatEven(tag, high, low), hn::ConcatOdd(tag, high, low)};
}

HWY_INLINE Numbers as_numbers(Words words) {
    Numbers r;
    r.part[0] = hn::BitCast(FloatTag(), words);
    return r;
}
/// The lower and the upper half of each word of 32 bits, as signed numbers.
HWY_INLINE Numbers lower_numbers(Words words) {
    const hn::RebindToSigned<FloatTag> integers;
    Numbers r;
    const auto low = hn::ShiftRight<16>(hn::ShiftLeft<16>(hn::BitCast(integers, words)));
    r.part[0] = hn::ConvertTo(FloatTag(), low);
    return r;
}
HWY_INLINE Numbers upper_numbers(Words words) {
    const hn::RebindToSigned<FloatTag> integers;
    Numbers r;
    const auto high = hn::ShiftRight<16>(hn::BitCast(integers, words));
    r.part[0] = hn::ConvertTo(FloatTag(), high);
    return r;
}

/// `importances` (light_importance.h) of both siblings of each point, operation by operation, and
/// their links. `kSimple`: all points count light of one side.
template <bool kSimple>
HWY_INLINE Numbers importances_of(const Walkers& w, Words& links) {
    constexpr float kUnit = 1.0f / LightTree::kAxisUnits;
    const auto [centers_x, centers_y] = members_of(w.pairs, 0);
    const auto [centers_z, variances] = members_of(w.pairs, 1);
    const auto [intensities, axes_xy] = members_of(w.pairs, 2);
    const auto [axes_z, both_links] = members_of(w.pairs, 3);
    links = both_links;
    const auto point = [&](std::size_t k) HWY_ATTR { return load_lanes<kLanes>(w.point[k]); };
    const auto normal = [&](std::size_t k) HWY_ATTR { return load_lanes<kLanes>(w.normal[k]); };
    const Numbers zero(0.0f), one(1.0f);
    const Numbers x = as_numbers(centers_x) - point(0), y = as_numbers(centers_y) - point(1),
                  z = as_numbers(centers_z) - point(2);
    const Numbers squared = x * x + y * y + z * z, variance = as_numbers(variances);
    const Numbers axis_x = lower_numbers(axes_xy), axis_y = upper_numbers(axes_xy);
    const Numbers axis_z = lower_numbers(axes_z);
    const Numbers radius2 = as_numbers(hn::And(axes_z, hn::Set(WordTag(), 0xFFFF0000FFFF0000u)));

    const Numbers along = -((axis_x * x + axis_y * y + axis_z * z) * Numbers(kUnit));
    const Numbers equal =
        (axis_x * axis_x + axis_y * axis_y + axis_z * axis_z) * Numbers(kUnit * kUnit);
    const Numbers turn = Numbers(kTurned) * max_lanes(one - equal, zero) + Numbers(kLeastTurn);
    const Numbers sent_root = sqrt(along * along + turn * squared + variance);
    const Numbers intensity = as_numbers(intensities);
    const Numbers sent = sent_root + select_lanes(intensity < zero, sent_root, along);

    const Numbers height = normal(0) * x + normal(1) * y + normal(2) * z;
    const Numbers grazing = Numbers(kGrazing) * squared, height2 = height * height;
    const Numbers received_root = sqrt(height2 + (variance + grazing));
    const Numbers spread = squared + variance;
    Numbers received = received_root + height;
    Mask dark = (height < zero) & (height2 >= radius2 + grazing);
    if (!kSimple) {
        const Mask in_volume = lanes_of_bits<float, kLanes>(w.in_volume);
        const Mask both_sides = lanes_of_bits<float, kLanes>(w.both_sides);
        received = received_root + select_lanes(both_sides, received_root, height);
        received = select_lanes(in_volume, Numbers(2.0f) * sqrt(spread), received);
        dark = dark & !(in_volume | both_sides);
    }
    const Numbers importance = abs(intensity) * sent * received / (spread * spread);
    return select_lanes(dark, zero, importance);
}

/// One step down the tree for each point that has not ended. The others stay where they are:
/// without branches, as the end of a point is not predictable.
template <bool kSimple>
HWY_INLINE void descend(const LightTree& tree, const LightRecord* lights, Walkers& w) {
    const DoubleTag tag;
    const WordTag words;
    Words both_links;
    const auto own = importances_of<kSimple>(w, both_links).part[0];
    const hn::Half<FloatTag> half;
    const auto of_first =
        hn::PromoteTo(tag, hn::LowerHalf(half, hn::ConcatEven(FloatTag(), own, own)));
    const auto of_second =
        hn::PromoteTo(tag, hn::LowerHalf(half, hn::ConcatOdd(FloatTag(), own, own)));
    const auto zero = hn::Zero(tag), one = hn::Set(tag, 1.0);
    const auto sum = hn::Add(of_first, of_second);
    const auto is_lit = hn::Gt(sum, zero);
    const auto probability = hn::Load(tag, w.probability), rest = hn::Load(tag, w.rest);
    // What follows waits for no division.
    const auto first = hn::Lt(hn::Mul(rest, sum), hn::Mul(probability, of_first));
    // No division by 0.
    const auto part = hn::Div(one, hn::IfThenElse(is_lit, sum, one));
    const auto of_choices = hn::Mul(probability, hn::Mul(of_first, part));
    const auto of_others = hn::Mul(probability, hn::Mul(of_second, part));
    hn::Store(hn::IfThenElse(first, rest, hn::Max(hn::Sub(rest, of_choices), zero)), tag, w.rest);

    const auto before = hn::Load(words, w.links);
    const auto leaf = hn::Set(words, kLeafBit);
    const auto walks = hn::Eq(hn::And(before, leaf), hn::Zero(words));
    const auto next = hn::IfThenElse(hn::RebindMask(words, first),
                                     hn::And(both_links, hn::Set(words, 0xFFFFFFFFu)),
                                     hn::ShiftRight<32>(both_links));
    const auto found = hn::IfThenElse(hn::RebindMask(words, is_lit), next, leaf);
    const auto links = hn::IfThenElse(walks, found, before);
    hn::Store(links, words, w.links);
    const auto taken = hn::IfThenElseZero(is_lit, hn::IfThenElse(first, of_choices, of_others));
    hn::Store(hn::IfThenElse(hn::RebindMask(tag, walks), taken, probability), tag, w.probability);

    const auto walk_on = hn::Eq(hn::And(links, leaf), hn::Zero(words));
    w.walk = !hn::AllFalse(words, walk_on);
    static_assert(sizeof(Siblings*) == sizeof(std::uint64_t) && sizeof(LightRecord) == 128);
    auto* const addresses = reinterpret_cast<std::uint64_t*>(w.pairs);
    const auto start = hn::Set(words, reinterpret_cast<std::uint64_t>(tree.pairs().data()));
    const auto there = hn::Add(start, hn::ShiftLeft<6>(links));
    hn::Store(hn::IfThenElse(walk_on, there, hn::Load(words, addresses)), words, addresses);
    // Of points that end, the first line of what is read of their lights.
    alignas(64) const char* fetched[kPoints];
    const auto light = hn::Add(hn::Set(words, reinterpret_cast<std::uint64_t>(lights)),
                               hn::ShiftLeft<7>(hn::AndNot(leaf, links)));
    hn::Store(hn::IfThenElse(walk_on, there, light), words,
              reinterpret_cast<std::uint64_t*>(fetched));
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kPoints; ++i) __builtin_prefetch(fetched[i]);
}

HWY_INLINE void begin(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                      std::size_t first, std::size_t count, Walkers& w) {
    set_points(tree, at, first, w);
    for (std::size_t i = 0; i < kPoints; ++i) {
        w.rest[i] = choices.of[first + i];
        w.probability[i] = 1.0;
        w.pairs[i] = &tree.pairs()[tree.root().target()];
        w.links[i] = i < count ? tree.root().bits() : kLeafBit;
    }
    w.walk = true;
}

inline void choose(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen, const LightRecord* lights) {
    // While one group takes a step, the next nodes of the other are fetched.
    constexpr std::size_t kGroups = LitPointLanes::kMost / kPoints;
    Walkers groups[kGroups];
    std::size_t used = 0;
    for (std::size_t first = 0; first < count; first += kPoints) {
        begin(tree, at, choices, first, std::min(kPoints, count - first), groups[used++]);
    }
    // Addresses of nothing would be looked up in all tables of pages.
    if (lights == nullptr) lights = reinterpret_cast<const LightRecord*>(tree.pairs().data());
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
