#pragma once
/// Builds a wide BVH quickly: primitives that are neighbors on a space-filling curve share a leaf,
/// and the tree above divides the curve where the places on it differ in the highest bit.
///
/// Source: Lauterbach et al., "Fast BVH Construction on GPUs", Computer Graphics Forum 28(2), 2009.
/// Differs: leaves are found by one pass along the curve, and filled and enclosed in boxes before
/// the tree is made, so that each primitive is read twice only; the binary tree over them is made
/// wide by `collapse`.
/// Complexity and threads: O(n), parallel; the result is the same for every number of threads.

#include <array>
#include <cstdint>
#include <span>

#include "alhazen/accel/wide_bvh/build/collapse.h"
#include "alhazen/simd/registers.h"

namespace alhazen {

/// A block of primitives of one kind that are neighbors on the curve.
struct CurveLeaf {
    std::uint64_t place;  ///< on the curve, of its first primitive
    std::uint32_t first;  ///< position of its first index
    std::uint32_t count;
    std::uint32_t kind;
    std::uint32_t offset;  ///< number of its block among those of the kind
};

/// The primitives to build over, numbered from 0, and the blocks to put them into.
class CurvePrimitives {
  public:
    virtual ~CurvePrimitives() = default;
    [[nodiscard]] virtual std::uint32_t size() const = 0;
    /// The kind of all primitives; kLeafKinds if they differ.
    [[nodiscard]] virtual std::uint32_t common_kind() const = 0;
    [[nodiscard]] virtual std::uint32_t kind(std::uint32_t index) const = 0;
    /// Writes the centers of the primitives from `begin` to `end`, the fourth lane 0. Must be
    /// thread-safe, like `fill`.
    virtual void centers(std::uint32_t begin, std::uint32_t end, Float4* to) const = 0;
    /// Allocates the blocks; called once, before they are filled.
    virtual void resize(const std::array<std::size_t, kLeafKinds>& blocks) = 0;
    /// Fills the block of each leaf; `indices` are those of all leaves, ascending in each. Writes
    /// the boxes of the leaves as references numbered from `first` on, and the areas as
    /// LeafSink::pack returns them.
    virtual void fill(std::span<const CurveLeaf> leaves, const std::uint32_t* indices,
                      std::uint32_t first, BuildReference* boxes, float* areas) const = 0;
};

/// `width` as for `collapse`. Kinds have blocks of at most kCurveLeafSize primitives.
[[nodiscard]] WideBvh build_along_curve(CurvePrimitives& primitives, const LeafKinds& kinds,
                                        std::uint32_t width = 8);

}  // namespace alhazen
