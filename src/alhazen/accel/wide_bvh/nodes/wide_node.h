#pragma once
/// The nodes of the wide BVH and the references between them.
///
/// Source: Wald, Benthin and Boulos, "Getting Rid of Packets", RT 2008 (wide nodes for single
/// rays).
/// Differs: rows of planes are chosen by the sign of the direction, so that no t is swapped; leaves
/// hold blocks of one kind of primitive each.
/// Conventions: boxes are in the local frame of the tree (`LocalFrame`), rounded outward.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace alhazen {

/// A child: an inner node, or a leaf of consecutive blocks of one kind.
class NodeRef {
  public:
    static constexpr std::uint32_t kMaxBlocks = 8;
    static constexpr std::uint32_t kMaxOffset = (1u << 25) - 1;
    static constexpr std::uint32_t kMaxNodes = 1u << 31;

    NodeRef() = default;  // uninitialised: the traversal stack holds hundreds
    [[nodiscard]] static NodeRef node(std::uint32_t index) { return NodeRef(index); }
    /// `count` blocks of `kind` (0 to 6), the first at `offset`.
    [[nodiscard]] static NodeRef leaf(std::uint32_t kind, std::uint32_t offset,
                                      std::uint32_t count) {
        return NodeRef(kLeafBit | kind << 28 | (count - 1) << 25 | offset);
    }
    /// A leaf of an unused kind: a sentinel that ends a ray's traversal.
    [[nodiscard]] static NodeRef none() { return leaf(7, 0, 1); }
    [[nodiscard]] static NodeRef from_bits(std::uint32_t bits) { return NodeRef(bits); }

    [[nodiscard]] bool is_leaf() const { return (bits_ & kLeafBit) != 0; }
    [[nodiscard]] std::uint32_t index() const { return bits_; }
    [[nodiscard]] std::uint32_t kind() const { return bits_ >> 28 & 7; }
    [[nodiscard]] std::uint32_t count() const { return (bits_ >> 25 & 7) + 1; }
    [[nodiscard]] std::uint32_t offset() const { return bits_ & kMaxOffset; }
    [[nodiscard]] std::uint32_t bits() const { return bits_; }
    /// A leaf of several blocks without the first.
    [[nodiscard]] NodeRef after_first_block() const { return NodeRef(bits_ - (1u << 25) + 1); }
    friend bool operator==(NodeRef, NodeRef) = default;

  private:
    static constexpr std::uint32_t kLeafBit = 1u << 31;
    explicit NodeRef(std::uint32_t bits) : bits_(bits) {}
    std::uint32_t bits_;
};

struct FloatBox {
    float lo[3] = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                   std::numeric_limits<float>::infinity()};
    float hi[3] = {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                   -std::numeric_limits<float>::infinity()};

    void include(const FloatBox& b) {
        for (int k = 0; k < 3; ++k) {
            lo[k] = b.lo[k] < lo[k] ? b.lo[k] : lo[k];
            hi[k] = b.hi[k] > hi[k] ? b.hi[k] : hi[k];
        }
    }
    /// The weight in the surface area heuristic: half the surface area, plus small terms for the
    /// edges and for each box, so that flat, thin and pointlike sets can be divided as well.
    /// Precondition: the box is not empty.
    [[nodiscard]] float weight() const {
        const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
        return x * y + y * z + z * x + 1e-6f * (x + y + z) + 1e-12f;
    }
    friend bool operator==(const FloatBox&, const FloatBox&) = default;
};

/// Valid numbers of children per node: BuildOptions::width.
inline constexpr std::size_t kNodeWidths[] = {4, 8, 16};

/// A node of 4, 8 or 16 children, in two, four or eight cache lines. No ray intersects the planes
/// of a free slot. Any-hit queries visit the children in the order of the slots; see collapse.h.
template <std::size_t Width>
struct alignas(Width == 4 ? 128 : 256) WideNodeOf {
    static constexpr std::size_t kWidth = Width;
    static constexpr std::uint32_t kSlotBits = std::bit_width(Width - 1);
    /// An integer with the index of every slot; it fills the rest of the cache lines.
    using Order = std::conditional_t<Width == 4, std::uint16_t,
                                     std::conditional_t<Width == 8, std::uint32_t, std::uint64_t>>;

    /// Rows lo.x, lo.y, lo.z, hi.x, hi.y, hi.z.
    float planes[6][Width];
    NodeRef child[Width]{};  ///< the slots in use are the first ones
    /// [octant of the direction] the slots from the farthest to the nearest, kSlotBits bits each
    /// from the lowest; bit k of the octant is set if component k is negative.
    Order order[8];

    WideNodeOf() {
        constexpr float kInf = std::numeric_limits<float>::infinity();
        for (std::size_t k = 0; k < 6; ++k) {
            for (float& plane : planes[k]) plane = k < 3 ? kInf : -kInf;
        }
        for (Order& slots : order) slots = slots_in_turn();
    }
    /// The order of a node without children.
    [[nodiscard]] static constexpr Order slots_in_turn() {
        std::uint64_t all = 0;
        for (std::uint64_t i = 0; i < Width; ++i) all |= i << kSlotBits * i;
        return static_cast<Order>(all);
    }
    /// Number of slots in use.
    [[nodiscard]] std::uint32_t child_count() const {
        std::uint32_t count = 0;
        for (const float lo : planes[0]) count += lo < std::numeric_limits<float>::infinity();
        return count;
    }
    /// Sets `order` for the current boxes.
    void set_order();
    void set_box(std::size_t slot, const FloatBox& box) {
        for (int k = 0; k < 3; ++k) {
            planes[k][slot] = box.lo[k];
            planes[k + 3][slot] = box.hi[k];
        }
    }
    [[nodiscard]] FloatBox box(std::size_t slot) const {
        FloatBox box;
        for (int k = 0; k < 3; ++k) {
            box.lo[k] = planes[k][slot];
            box.hi[k] = planes[k + 3][slot];
        }
        return box;
    }
};
/// The default width.
using WideNode = WideNodeOf<8>;
static_assert(sizeof(WideNodeOf<4>) == 128 && sizeof(WideNodeOf<8>) == 256 &&
              sizeof(WideNodeOf<16>) == 512);

template <std::size_t Width>
void WideNodeOf<Width>::set_order() {
    const std::uint32_t used = child_count();
    for (std::uint32_t octant = 0; octant < 4; ++octant) {
        float along[Width];
        for (std::size_t i = 0; i < Width; ++i) {
            along[i] = 0;
            if (i >= used) continue;
            for (std::uint32_t k = 0; k < 3; ++k) {
                const float center2 = planes[k][i] + planes[k + 3][i];
                along[i] += (octant >> k & 1) != 0 ? -center2 : center2;
            }
        }
        std::uint32_t slots[Width];
        for (std::uint32_t i = 0; i < used; ++i) {
            std::uint32_t place = i;
            for (; place > 0 && along[slots[place - 1]] < along[i]; --place) {
                slots[place] = slots[place - 1];
            }
            slots[place] = i;
        }
        // The opposite octant has the reverse order; free slots stay.
        std::uint64_t all = 0, across = 0;
        for (std::uint32_t i = 0; i < Width; ++i) {
            const std::uint64_t a = i < used ? slots[i] : i;
            const std::uint64_t b = i < used ? slots[used - 1 - i] : i;
            all |= a << kSlotBits * i;
            across |= b << kSlotBits * i;
        }
        order[octant] = static_cast<Order>(all);
        order[7 - octant] = static_cast<Order>(across);
    }
}

/// Maximum levels of inner nodes; determines the size of the traversal stacks.
inline constexpr int kMaxWideDepth = 88;
template <std::size_t Width>
inline constexpr std::size_t kTraversalStackSize = (Width - 1) * kMaxWideDepth + 8;

}  // namespace alhazen
