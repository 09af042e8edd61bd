/// The subtrees that a ray has yet to visit, for the traversals by one ray and by several in turn.
///
/// Source: Fuetterling, Lojewski, Pfreundt, Hamann and Ebert, "Accelerated Single Ray Tracing for
/// Wide Vector Units", HPG 2017 (children sorted by the octant of the ray and compressed onto the
/// stack).
/// Differs: the order of an octant is that of the centers of the boxes along its diagonal; any-hit
/// queries have one order for all octants (collapse.h); the nearest child may be kept apart.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_NODE_STACK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_NODE_STACK_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_NODE_STACK_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_NODE_STACK_INL_H_
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The bits of an entry that count where children are compared: the others hold a slot.
template <std::size_t W>
inline constexpr std::uint32_t kEntryBits = ~(static_cast<std::uint32_t>(W) - 1);

/// Whether the child of a higher slot is nearer. Precondition: entries are not negative, so that
/// they are ordered as their bits.
template <std::size_t W>
HWY_INLINE bool is_nearer(float entry, float entry_of_lower_slot) {
    return (std::bit_cast<std::uint32_t>(entry) & kEntryBits<W>) <
           (std::bit_cast<std::uint32_t>(entry_of_lower_slot) & kEntryBits<W>);
}

/// Largest number of subtrees with which a ray of a stream begins.
inline constexpr std::size_t kMostBegun = 64;

/// The subtrees to visit, with entry parameters and references in separate arrays, so that lanes
/// are stored. The height is kept outside, in a register. The lowest element is a sentinel.
template <std::size_t W>
struct NodeStack {
    static constexpr std::size_t kSize = 1 + kMostBegun + kTraversalStackSize<W> + W;
    float entry[kSize];
    std::uint32_t child[kSize];

    HWY_INLINE void clear() {
        entry[0] = -std::numeric_limits<float>::infinity();
        child[0] = NodeRef::none().bits();
    }

    /// Pushes the children that the ray enters before it leaves them: the farthest first by the
    /// order of the octant, or else those of the highest slots first.
    template <bool kOrdered, std::size_t kRegisters = kParts<float, W>>
    [[nodiscard]] HWY_INLINE std::size_t push(std::size_t height, const WideNodeOf<W>& node,
                                              const Lanes<float, W>& entries,
                                              const Lanes<float, W>& exits, std::uint32_t octant) {
        if constexpr (kRegisters == 1) {
            return push_lanes<kOrdered>(height, node, entries, exits, octant);
        } else {
            HWY_ALIGN float near[W];
            store_lanes(entries, near);
            const std::uint32_t bits = bits_of(entries <= exits);
            auto order = node.order[octant];
            for (std::size_t i = 0; i < W; ++i) {
                const std::size_t slot = kOrdered ? order & (W - 1) : W - 1 - i;
                order = static_cast<decltype(order)>(order >> WideNodeOf<W>::kSlotBits);
                entry[height] = near[slot];
                child[height] = node.child[slot].bits();
                height += bits >> slot & 1;
            }
            return height;
        }
    }

    /// Removes what begins beyond `s_max`; the height that is left.
    template <std::size_t kRegisters = kParts<float, W>>
    [[nodiscard]] HWY_INLINE std::size_t drop_beyond(std::size_t height, float s_max) {
        std::size_t left = 1;  // the sentinel stays
        if constexpr (kRegisters == 1) {
            const Tag d;
            const auto most = hn::Set(d, s_max);
            for (std::size_t i = 1; i < height; i += W) {
                const auto near = hn::LoadU(d, entry + i);
                const auto children = hn::LoadU(d, reinterpret_cast<const float*>(child + i));
                const auto mask = hn::And(hn::Le(near, most), hn::FirstN(d, height - i));
                const auto first = first_lanes(mask);
                hn::StoreU(first(near), d, entry + left);
                hn::StoreU(first(children), d, reinterpret_cast<float*>(child + left));
                left += hn::CountTrue(d, mask);
            }
        } else {
            for (std::size_t i = 1; i < height; ++i) {
                entry[left] = entry[i];
                child[left] = child[i];
                left += entry[i] <= s_max;
            }
        }
        return left;
    }

    /// Pushes the children that are hit but for the nearest, which it returns: the others by the
    /// order of the octant, the farthest first. `bits` are those of `hit`, at least two.
    template <std::size_t kRegisters = kParts<float, W>>
    [[nodiscard]] HWY_INLINE std::size_t push_but_nearest(
        std::size_t& height, const WideNodeOf<W>& node, const Lanes<float, W>& entries,
        const LaneMask<float, W>& hit, std::uint32_t bits, std::uint32_t octant) {
        if constexpr (kRegisters == 1) {
            const std::size_t nearest = push_lanes_but_nearest(height, node, entries, hit, octant);
            height += static_cast<std::size_t>(std::popcount(bits)) - 1;
            return nearest;
        } else {
            HWY_ALIGN float near[W];
            store_lanes(entries, near);
            auto nearest = static_cast<std::size_t>(std::countr_zero(bits));
            for (std::uint32_t rest = bits & (bits - 1); rest != 0; rest &= rest - 1) {
                const auto slot = static_cast<std::size_t>(std::countr_zero(rest));
                if (is_nearer<W>(near[slot], near[nearest])) nearest = slot;
            }
            bits &= ~(1u << nearest);
            auto order = node.order[octant];
            for (std::size_t i = 0; i < W; ++i) {
                const std::size_t slot = order & (W - 1);
                order = static_cast<decltype(order)>(order >> WideNodeOf<W>::kSlotBits);
                entry[height] = near[slot];
                child[height] = node.child[slot].bits();
                height += bits >> slot & 1;
            }
            return nearest;
        }
    }

    /// Pushes the children of `bits`, if any, without their entries, those of the highest slots
    /// first: with a jump for each, or without, for numbers of children that are not predictable.
    HWY_INLINE void push_one_by_one(std::size_t& height, const WideNodeOf<W>& node,
                                    std::uint32_t bits) {
        for (; bits != 0; bits &= ~(0x80000000u >> std::countl_zero(bits))) {
            const auto slot = static_cast<std::size_t>(31 - std::countl_zero(bits));
            child[height++] = node.child[slot].bits();
        }
    }
    template <std::size_t kRegisters = kParts<float, W>>
    HWY_INLINE void push_at_once(std::size_t& height, const WideNodeOf<W>& node,
                                 std::uint32_t bits) {
        if constexpr (kRegisters == 1) {
            const Tag d;
            const auto mask = hn::VecFromMask(d, lanes_of_bits<float, W>(bits).part[0]);
            const auto children = hn::Load(d, reinterpret_cast<const float*>(node.child));
            const auto first = first_lanes(hn::MaskFromVec(hn::Reverse(d, mask)));
            hn::StoreU(first(hn::Reverse(d, children)), d,
                       reinterpret_cast<float*>(child + height));
            height += static_cast<std::size_t>(std::popcount(bits));
        } else {
            push_one_by_one(height, node, bits);
        }
    }

  private:
    using Tag = LaneTag<float, W>;

    /// [lane] The slot of the child that belongs there.
    static HWY_INLINE auto slots_of(const WideNodeOf<W>& node, std::uint32_t octant) {
        const hn::RebindToUnsigned<Tag> du;
        constexpr std::uint32_t kBits = WideNodeOf<W>::kSlotBits;
        constexpr std::uint32_t kInWord = 32 / kBits;  // slots in 32 bits of an order
        HWY_ALIGN static constexpr auto kShifts = [] {
            std::array<std::uint32_t, W> shifts{};
            for (std::uint32_t i = 0; i < W; ++i) shifts[i] = i % kInWord * kBits;
            return shifts;
        }();
        const auto order = node.order[octant];
        auto word = hn::Set(du, static_cast<std::uint32_t>(order));
        if constexpr (W > kInWord) {
            const auto rest = hn::Set(du, static_cast<std::uint32_t>(order >> 32));
            word = hn::IfThenElse(hn::FirstN(du, kInWord), word, rest);
        }
        return hn::And(hn::Shr(word, hn::Load(du, kShifts.data())), hn::Set(du, W - 1));
    }

    /// Moves the lanes of `mask` to the front, as hn::Compress. The version of AVX2 reads a table
    /// that GCC first copies to the stack, 1 KiB per call.
    static HWY_INLINE auto first_lanes(const hn::Mask<Tag>& mask) {
#if HWY_TARGET == HWY_AVX2
        if constexpr (W == 8) {
            static constexpr auto kPlaces = [] {
                std::array<std::array<std::uint8_t, 8>, 256> places{};
                for (std::uint32_t bits = 0; bits < 256; ++bits) {
                    std::size_t count = 0;
                    for (std::uint8_t i = 0; i < 8; ++i) {
                        if ((bits >> i & 1) != 0) places[bits][count++] = i;
                    }
                }
                return places;
            }();
            std::uint8_t bits[8];
            hn::StoreMaskBits(Tag(), mask, bits);
            const auto places =
                hn::PromoteTo(hn::RebindToSigned<Tag>(),
                              hn::LoadU(hn::Rebind<std::uint8_t, Tag>(), kPlaces[bits[0]].data()));
            const auto indices = hn::IndicesFromVec(Tag(), places);
            return [indices](const hn::Vec<Tag>& v)
                       HWY_ATTR { return hn::TableLookupLanes(v, indices); };
        } else
#endif
        {
            return [mask](const hn::Vec<Tag>& v) HWY_ATTR { return hn::Compress(v, mask); };
        }
    }

    template <bool kOrdered>
    HWY_INLINE std::size_t push_lanes(std::size_t height, const WideNodeOf<W>& node,
                                      const Lanes<float, W>& entries, const Lanes<float, W>& exits,
                                      std::uint32_t octant) {
        const Tag d;
        const auto children = hn::Load(d, reinterpret_cast<const float*>(node.child));
        // Put in order before they are compared: two lookups at a time in place of one comparison
        // before the lookup and one after it.
        const auto push_in_order = [&](auto&& in_order) HWY_ATTR {
            const auto near = in_order(entries.part[0]);
            const auto mask = hn::Le(near, in_order(exits.part[0]));
            const auto first = first_lanes(mask);
            const auto first_children = first(in_order(children));
            hn::StoreU(first(near), d, entry + height);
            hn::StoreU(first_children, d, reinterpret_cast<float*>(child + height));
            return height + hn::CountTrue(d, mask);
        };
        if constexpr (kOrdered) {
            const hn::RebindToSigned<Tag> di;
            const auto places = hn::IndicesFromVec(d, hn::BitCast(di, slots_of(node, octant)));
            return push_in_order([&](const auto& v)
                                     HWY_ATTR { return hn::TableLookupLanes(v, places); });
        } else {
            return push_in_order([&](const auto& v) HWY_ATTR { return hn::Reverse(d, v); });
        }
    }
    /// As push_but_nearest, but leaves `height` to the caller.
    HWY_INLINE std::size_t push_lanes_but_nearest(std::size_t height, const WideNodeOf<W>& node,
                                                  const Lanes<float, W>& entries,
                                                  const LaneMask<float, W>& hit,
                                                  std::uint32_t octant) {
        const Tag d;
        const hn::RebindToUnsigned<Tag> du;
        const hn::RebindToSigned<Tag> di;
        // Negative, which no entry is: as a number without a sign greater than any of them.
        const auto missed = hn::Set(d, -1.0f);
        const auto near = hn::IfThenElse(hit.part[0], entries.part[0], missed);
        // Entry and slot in one number, compared as by is_nearer.
        const auto numbers =
            hn::Or(hn::And(hn::BitCast(du, near), hn::Set(du, kEntryBits<W>)), hn::Iota(du, 0));
        const auto least = hn::MinOfLanes(du, numbers);
        const auto rest = hn::IfThenElse(hn::RebindMask(d, hn::Eq(numbers, least)), missed, near);
        const auto places = hn::IndicesFromVec(d, hn::BitCast(di, slots_of(node, octant)));
        const auto in_order = hn::TableLookupLanes(rest, places);
        const auto first = first_lanes(hn::Ge(in_order, hn::Zero(d)));
        const auto children = hn::Load(d, reinterpret_cast<const float*>(node.child));
        hn::StoreU(first(in_order), d, entry + height);
        hn::StoreU(first(hn::TableLookupLanes(children, places)), d,
                   reinterpret_cast<float*>(child + height));
        return hn::GetLane(least) & (W - 1);
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
