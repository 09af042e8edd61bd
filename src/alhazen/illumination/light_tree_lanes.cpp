#include "alhazen/illumination/light_tree_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/illumination/light_tree_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <algorithm>
#include <bit>
#include <cstddef>

#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace light_choices {

#undef ALHAZEN_EIGHT_POINTS

using Siblings = LightTree::Siblings;

/// Both siblings of several pairs: lanes 2 i and 2 i + 1 belong to point i. Smaller registers than
/// those of 512 bits gain nothing from more points than two.
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
#define ALHAZEN_EIGHT_POINTS 1
constexpr std::size_t kPoints = 8;
#else
#define ALHAZEN_EIGHT_POINTS 0
constexpr std::size_t kPoints = 2;
#endif
constexpr std::size_t kLanes = 2 * kPoints;
using Numbers = Lanes<double, kLanes>;
using Mask = LaneMask<double, kLanes>;

#if !ALHAZEN_EIGHT_POINTS
#if HWY_TARGET != HWY_SCALAR
/// A register of blocks of 16 bytes; block i is at numbers(*of[i]).
template <class Tag, class Of>
HWY_INLINE hn::Vec<Tag> blocks_of(Tag tag, const Siblings* const* of, const Of& numbers) {
    constexpr std::size_t kBlocks = hn::MaxLanes(tag) * sizeof(hn::TFromD<Tag>) / 16;
    if constexpr (kBlocks == 1) {
        return hn::LoadU(tag, numbers(*of[0]));
    } else {
        const hn::Half<Tag> half;
        return hn::Combine(tag, blocks_of(half, of + kBlocks / 2, numbers),
                           blocks_of(half, of, numbers));
    }
}
#endif
/// Numbers of two siblings, at numbers(*of[i]).
template <class Of>
HWY_INLINE Numbers joined(const Siblings* const* of, const Of& numbers) {
    Numbers r;
    const LaneTag<double, kLanes> tag;
    for (std::size_t i = 0; i < kParts<double, kLanes>; ++i) {
#if HWY_TARGET == HWY_SCALAR
        r.part[i] = hn::Set(tag, numbers(*of[i / 2])[i % 2]);
#else
        r.part[i] = blocks_of(tag, of + i * hn::MaxLanes(tag) / 2, numbers);
#endif
    }
    return r;
}
/// Two successive numbers of Siblings, as `joined`.
struct TwoNumbers {
    Numbers first, second;
};
template <class Of>
HWY_INLINE TwoNumbers joined_floats(const Siblings* const* of, const Of& numbers) {
#if HWY_TARGET == HWY_SCALAR
    TwoNumbers r;
    for (std::size_t i = 0; i < kLanes; ++i) {
        const float* from = numbers(*of[i / 2]) + i % 2;
        r.first.part[i] = hn::Set(LaneTag<double, kLanes>(), double{from[0]});
        r.second.part[i] = hn::Set(LaneTag<double, kLanes>(), double{from[2]});
    }
    return r;
#else
    // Two floats are moved as one number.
    const LaneTag<float, kLanes> tag;
    const hn::Repartition<std::uint64_t, LaneTag<float, kLanes> > twos;
    Lanes<float, kLanes> first, second;
    for (std::size_t i = 0; i < kParts<float, kLanes>; ++i) {
        constexpr std::size_t kBlocks = hn::MaxLanes(tag) / 4;
        const Siblings* const* from = of + 2 * i * kBlocks;
        const auto low = hn::BitCast(twos, blocks_of(tag, from, numbers));
        const auto high = hn::BitCast(twos, blocks_of(tag, from + kBlocks, numbers));
        first.part[i] = hn::BitCast(tag, hn::ConcatEven(twos, high, low));
        second.part[i] = hn::BitCast(tag, hn::ConcatOdd(twos, high, low));
    }
    return {as_doubles(first), as_doubles(second)};
#endif
}
#endif

/// The numbers of siblings that an importance depends on.
struct PairNumbers {
    Numbers center[3], radius2, axis[3], spread, reach, intensity;
};

/// std::max(b, a) and std::min(b, a) of each lane: a NaN in `a` gives `b`. On x86 one instruction.
template <class N>
HWY_INLINE N larger_of(const N& a, const N& b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
    return max_lanes(a, b);
#else
    return select_lanes(a > b, a, b);
#endif
}
template <class N>
HWY_INLINE N smaller_of(const N& a, const N& b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
    return min_lanes(a, b);
#else
    return select_lanes(a < b, a, b);
#endif
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

/// Points in lanes. Each number is there twice, for both siblings.
struct Points {
    alignas(64) double point[3][kLanes], normal[3][kLanes];
    std::uint32_t both_sides = 0, in_volume = 0;  ///< bits of lanes

    /// Sets them to the points from `first` on.
    void set(const LitPointLanes& at, std::size_t first) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::size_t i = first + lane / 2;
            for (int k = 0; k < 3; ++k) {
                point[k][lane] = at.point[k][i];
                normal[k][lane] = at.normal[k][i];
            }
            both_sides |= (at.both_sides >> i & 1u) << lane;
            in_volume |= (at.in_volume >> i & 1u) << lane;
        }
    }
};

/// `importance` (light_importance.h) of both siblings of each point, operation by operation.
/// `kSimple`: all points count light of one side, and all lights are surfaces.
template <bool kSimple>
HWY_INLINE Numbers importances_of(const Points& w, const PairNumbers& of) {
    const auto& [axis_x, axis_y, axis_z] = of.axis;
    const Numbers &spread = of.spread, &reach = of.reach, &signed_intensity = of.intensity;
    const Numbers& radius2 = of.radius2;
    const Numbers one(1.0), zero(0.0), least(0x1p-1074);
    const auto offset = [&](std::size_t k) {
        return of.center[k] - load_lanes<kLanes>(w.point[k]);
    };
    const Numbers x = offset(0), y = offset(1), z = offset(2);
    const Numbers true_squared = x * x + y * y + z * z, intensity = abs(signed_intensity);
    const Mask in_volume = lanes_of_bits<double, kLanes>(w.in_volume);
    const Mask both_sides = lanes_of_bits<double, kLanes>(w.both_sides);
    // Inside the sphere around the node all directions are possible.
    const Mask outside = true_squared > radius2;
    // At its centre no division by 0.
    const Numbers squared = larger_of(true_squared, least);
    const Numbers distance = sqrt(squared);
    const Numbers to_x = x / distance, to_y = y / distance, to_z = z / distance;
    const Numbers sine_b = smaller_of(sqrt(radius2) / distance, one);
    const Numbers cosine_b = sqrt(one - sine_b * sine_b);

    Numbers cosine_w = -(axis_x * to_x + axis_y * to_y + axis_z * to_z);
    cosine_w = clamped_cosine(select_lanes(signed_intensity < zero, abs(cosine_w), cosine_w));
    Numbers cosine_x = one, sine_x = zero;
    // Of few points often all are in the cone.
    if (kPoints > 2 || bits_of((!(cosine_w > spread)) & outside) != 0) {
        const Numbers sine_w = sine_of(cosine_w), sine_o = sine_of(spread);
        cosine_x = cosine_of_difference(cosine_w, sine_w, spread, sine_o);
        sine_x = sine_of_difference(cosine_w, sine_w, spread, sine_o);
    }
    const Numbers cosine_out = cosine_of_difference(cosine_x, sine_x, cosine_b, sine_b);
    // Lights other than surfaces have no cosine.
    const Numbers sent =
        intensity * (kSimple ? cosine_out : select_lanes(reach < zero, one, cosine_out));

    const auto normal = [&](std::size_t k) { return load_lanes<kLanes>(w.normal[k]); };
    Numbers cosine_i = normal(0) * to_x + normal(1) * to_y + normal(2) * to_z;
    if (!kSimple) cosine_i = select_lanes(both_sides, abs(cosine_i), cosine_i);
    cosine_i = clamped_cosine(cosine_i);
    const Numbers received = cosine_of_difference(cosine_i, sine_of(cosine_i), cosine_b, sine_b);
    Mask arrives = received > zero;
    Numbers arriving = sent * received;
    if (!kSimple) {
        arrives = in_volume | arrives;
        arriving = select_lanes(in_volume, sent, arriving);
    }
    const Mask leaves = !(cosine_out <= (kSimple ? zero : reach));
    const Numbers result = select_lanes(outside, arriving, intensity) /
                           select_lanes(outside, squared, larger_of(Numbers(1e-300), radius2));
    return select_lanes((leaves & arrives) | !outside, result, zero);
}

#if ALHAZEN_EIGHT_POINTS

/// The bit of a link to a light, and the link to light 0.
const std::uint64_t kLeafBit = LightTree::Link::to_light(0).bits();

using Register = hn::Vec<LaneTag<double, kLanes> >;
static_assert(sizeof(Siblings) == 128 && offsetof(Siblings, radius2) == 48 &&
              offsetof(Siblings, axis) == 64 && offsetof(Siblings, links) == 112);

/// Register i has the block i (16 bytes) of each of four lines of 64 bytes.
struct FourBlocks {
    Register of[4];
};
HWY_INLINE FourBlocks blocks_of_lines(const Siblings* const* pairs, std::size_t line) {
    const LaneTag<double, kLanes> tag;
    const hn::Half<LaneTag<double, kLanes> > half;
    const auto halves = [&](std::size_t i, std::size_t block) HWY_ATTR {
        const auto numbers = [&](std::size_t k) {
            return reinterpret_cast<const double*>(pairs[k]) + 8 * line + 2 * block;
        };
        return hn::Combine(tag, hn::Load(half, numbers(i + 1)), hn::Load(half, numbers(i)));
    };
    FourBlocks blocks;
    for (std::size_t block = 0; block < 4; block += 2) {
        const auto low = halves(0, block), high = halves(2, block);
        blocks.of[block] = Register{_mm512_shuffle_f64x2(low.raw, high.raw, 0x88)};
        blocks.of[block + 1] = Register{_mm512_shuffle_f64x2(low.raw, high.raw, 0xDD)};
    }
    return blocks;
}

/// Points on their way down the tree.
struct Walkers : Points {
    alignas(64) double choice[kPoints], probability[kPoints];
    alignas(64) const Siblings* pairs[kPoints];  ///< whose siblings are next
    alignas(64) std::uint64_t links[kPoints];    ///< LightTree::Link, taken last
    bool walk = false;                           ///< some links lead to siblings
};

/// Reads the numbers of the next siblings, and their links.
HWY_INLINE hn::Vec<hn::ScalableTag<std::uint64_t> > load_pairs(const Walkers& w, PairNumbers& to) {
    const hn::ScalableTag<std::uint64_t> words;
    for (std::size_t i = 0; i < 2; ++i) {
        const FourBlocks blocks = blocks_of_lines(w.pairs + 4 * i, 0);
        for (int k = 0; k < 3; ++k) to.center[k].part[i] = blocks.of[k];
        to.radius2.part[i] = blocks.of[3];
    }
    const FourBlocks low = blocks_of_lines(w.pairs, 1), high = blocks_of_lines(w.pairs + 4, 1);
    // Pairs of floats are moved as words.
    const auto even = [&](std::size_t k) HWY_ATTR {
        return hn::ConcatEven(words, hn::BitCast(words, high.of[k]), hn::BitCast(words, low.of[k]));
    };
    const auto odd = [&](std::size_t k) HWY_ATTR {
        return hn::ConcatOdd(words, hn::BitCast(words, high.of[k]), hn::BitCast(words, low.of[k]));
    };
    const auto numbers = [&](auto pairs_of_floats) HWY_ATTR {
        Lanes<float, kLanes> floats;
        floats.part[0] = hn::BitCast(LaneTag<float, kLanes>(), pairs_of_floats);
        return as_doubles(floats);
    };
    to.axis[0] = numbers(even(0));
    to.axis[1] = numbers(odd(0));
    to.axis[2] = numbers(even(1));
    to.spread = numbers(odd(1));
    to.reach = numbers(even(2));
    to.intensity = numbers(odd(2));
    return even(3);
}

/// One step down the tree for each point that has not ended. The others stay where they are:
/// without branches, as the end of a point is not predictable.
template <bool kSimple>
HWY_INLINE void descend(const LightTree& tree, const LightRecord* lights, Walkers& w) {
    static_assert(sizeof(LightRecord) == 128);
    const hn::ScalableTag<double> tag;
    const hn::ScalableTag<std::uint64_t> words;
    PairNumbers numbers;
    const auto both_links = load_pairs(w, numbers);
    const Numbers own = importances_of<kSimple>(w, numbers);
    const auto of_first = hn::ConcatEven(tag, own.part[1], own.part[0]);
    const auto of_second = hn::ConcatOdd(tag, own.part[1], own.part[0]);
    const auto zero = hn::Zero(tag), one = hn::Set(tag, 1.0);
    const auto sum = hn::Add(of_first, of_second);
    const auto is_lit = hn::Gt(sum, zero);
    // No division of 0 by 0.
    const auto divisor = hn::Max(sum, hn::Set(tag, 0x1p-1074));
    const auto part = hn::Div(of_first, divisor), other = hn::Div(of_second, divisor);
    const auto choice = hn::Load(tag, w.choice);
    const auto first = hn::Lt(choice, part);

    const auto before = hn::Load(words, w.links);
    const auto leaf = hn::Set(words, kLeafBit);
    const auto walks = hn::Eq(hn::And(before, leaf), hn::Zero(words));
    const auto next = hn::IfThenElse(hn::RebindMask(words, first),
                                     hn::And(both_links, hn::Set(words, 0xFFFFFFFFu)),
                                     hn::ShiftRight<32>(both_links));
    const auto found = hn::IfThenElse(hn::RebindMask(words, is_lit), next, leaf);
    const auto links = hn::IfThenElse(walks, found, before);
    hn::Store(links, words, w.links);
    const auto walk_on = hn::Eq(hn::And(links, leaf), hn::Zero(words));
    w.walk = !hn::AllFalse(words, walk_on);
    static_assert(sizeof(Siblings*) == sizeof(std::uint64_t));
    auto* const addresses = reinterpret_cast<std::uint64_t*>(w.pairs);
    const auto start = reinterpret_cast<std::uint64_t>(tree.pairs().data());
    const auto offset = hn::ShiftLeft<7>(links);
    const auto there = hn::Add(hn::Set(words, start), offset);
    hn::Store(hn::IfThenElse(walk_on, there, hn::Load(words, addresses)), words, addresses);
    // Of points that end, what is read of their lights.
    alignas(64) const char* fetched[kPoints];
    const auto light = hn::Add(hn::Set(words, reinterpret_cast<std::uint64_t>(lights)),
                               hn::ShiftLeft<7>(hn::AndNot(leaf, links)));
    hn::Store(hn::IfThenElse(walk_on, there, light), words,
              reinterpret_cast<std::uint64_t*>(fetched));
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kPoints; ++i) {
        const char* const lines = fetched[i];
        __builtin_prefetch(lines);
        __builtin_prefetch(lines + 64);
    }

    const auto taken = hn::IfThenElseZero(is_lit, hn::IfThenElse(first, part, other));
    const auto probability = hn::Load(tag, w.probability);
    hn::Store(hn::IfThenElse(hn::RebindMask(tag, walks), hn::Mul(probability, taken), probability),
              tag, w.probability);
    const auto rest = hn::Div(hn::Sub(choice, hn::IfThenElseZero(hn::Not(first), part)),
                              hn::IfThenElse(first, part, hn::Sub(one, part)));
    // std::min.
    hn::Store(hn::Min(hn::Set(tag, 0x1.fffffffffffffp-1), rest), tag, w.choice);
}

HWY_INLINE void begin(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                      std::size_t first, std::size_t count, Walkers& w) {
    w.set(at, first);
    for (std::size_t i = 0; i < kPoints; ++i) {
        w.choice[i] = choices.of[first + i];
        w.probability[i] = 1.0;
        w.pairs[i] = &tree.pairs()[tree.root().target()];
        w.links[i] = i < count ? tree.root().bits() : kLeafBit;
    }
    w.walk = true;
}

inline void choose(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen,
                   [[maybe_unused]] const LightRecord* lights) {
    // While one group takes a step, the next nodes of the other are fetched.
    constexpr std::size_t kGroups = LitPointLanes::kMost / kPoints;
    Walkers groups[kGroups];
    std::size_t used = 0;
    for (std::size_t first = 0; first < count; first += kPoints) {
        begin(tree, at, choices, first, std::min(kPoints, count - first), groups[used++]);
    }
    // Addresses of nothing would be looked up in all tables of pages.
    if (lights == nullptr) lights = reinterpret_cast<const LightRecord*>(tree.pairs().data());
    const bool simple = tree.has_surfaces_only() && (at.both_sides | at.in_volume) == 0;
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

#else

/// The number of the first, or of the second sibling, for both.
HWY_INLINE TwoNumbers apart(const Numbers& a) {
    TwoNumbers r;
    for (std::size_t i = 0; i < kParts<double, kLanes>; ++i) {
#if HWY_TARGET == HWY_SCALAR
        r.first.part[i] = a.part[i & ~std::size_t{1}];
        r.second.part[i] = a.part[i | 1];
#else
        r.first.part[i] = hn::DupEven(a.part[i]);
        r.second.part[i] = hn::DupOdd(a.part[i]);
#endif
    }
    return r;
}

/// Points on their way down the tree. Each number is there twice, as its lanes.
struct Walkers : Points {
    alignas(64) double choice[kLanes], probability[kLanes];
    std::uint32_t left = 0;          ///< bits of the points on their way
    const Siblings* pairs[kPoints];  ///< whose siblings are next
};

HWY_INLINE void load_pairs(const Walkers& w, PairNumbers& to) {
    const auto& of = w.pairs;
    for (std::size_t k = 0; k < 3; ++k) {
        to.center[k] = joined(of, [k](const Siblings& s) { return s.center[k]; });
    }
    to.radius2 = joined(of, [](const Siblings& s) { return s.radius2; });
    const TwoNumbers xy = joined_floats(of, [](const Siblings& s) { return s.axis[0]; });
    const TwoNumbers z = joined_floats(of, [](const Siblings& s) { return s.axis[2]; });
    const TwoNumbers rest = joined_floats(of, [](const Siblings& s) { return s.cosine_reach; });
    to.axis[0] = xy.first;
    to.axis[1] = xy.second;
    to.axis[2] = z.first;
    to.spread = z.second;
    to.reach = rest.first;
    to.intensity = rest.second;
}

/// One step down the tree for each of the points `left`. Keeps those that go on.
HWY_INLINE void descend(const LightTree& tree, Walkers& w, ChosenLight* chosen) {
    const Siblings* const pairs = tree.pairs().data();
    PairNumbers numbers;
    load_pairs(w, numbers);
    const Numbers own = importances_of<false>(w, numbers), zero(0.0), one(1.0);
    const auto [of_first, of_second] = apart(own);
    const Numbers sum = of_first + of_second;
    const Mask is_lit = sum > zero;
    // No division of 0 by 0.
    const auto [part, other] = apart(own / select_lanes(is_lit, sum, one));
    const Numbers choice = load_lanes<kLanes>(w.choice);
    const Mask first = choice < part;
    store_lanes(load_lanes<kLanes>(w.probability) * select_lanes(first, part, other),
                w.probability);
    const Numbers rest =
        (choice - select_lanes(first, zero, part)) / select_lanes(first, part, one - part);
    // std::min.
    const Numbers most(0x1.fffffffffffffp-1);
    store_lanes(select_lanes(most < rest, most, rest), w.choice);
    const std::uint32_t lit = bits_of(is_lit), second = ~bits_of(first);
    for (std::uint32_t left = w.left; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        const LightTree::Link link = w.pairs[i]->links[second >> 2 * i & 1u];
        if ((lit >> 2 * i & 1u) == 0 || link.is_leaf()) {
            chosen[i] = (lit >> 2 * i & 1u) == 0 ? ChosenLight{}
                                                 : ChosenLight{link.target(), w.probability[2 * i]};
            w.left &= ~(1u << i);
            continue;
        }
        w.pairs[i] = pairs + link.target();
        const auto* const next = reinterpret_cast<const char*>(w.pairs[i]);
        __builtin_prefetch(next);
        __builtin_prefetch(next + 64);
    }
}

/// Sets the points first .. first + count - 1.
HWY_INLINE void begin(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                      std::size_t first, std::size_t count, Walkers& w) {
    w.set(at, first);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        w.choice[lane] = choices.of[first + lane / 2];
        w.probability[lane] = 1.0;
    }
    std::fill(std::begin(w.pairs), std::end(w.pairs), &tree.pairs()[tree.root().target()]);
    w.left = (1u << count) - 1;
}

inline void choose(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen,
                   [[maybe_unused]] const LightRecord* lights) {
    // While one group takes a step, the next nodes of the other are fetched.
    constexpr std::size_t kGroups = LitPointLanes::kMost / kPoints;
    Walkers groups[kGroups];
    std::size_t used = 0;
    for (std::size_t first = 0; first < count; first += kPoints) {
        begin(tree, at, choices, first, std::min(kPoints, count - first), groups[used++]);
    }
    for (bool any = true; any;) {
        any = false;
        for (std::size_t k = 0; k < used; ++k) {
            if (groups[k].left == 0) continue;
            descend(tree, groups[k], chosen + k * kPoints);
            any = any || groups[k].left != 0;
        }
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
    } else if (count == 1) {
        chosen[0] = tree.choose(at[0], choices.of[0]);
    } else {
        ALHAZEN_KERNEL(choose_lights_of_target)(tree, at, choices, count, chosen, lights);
    }
}

}  // namespace alhazen
#endif
