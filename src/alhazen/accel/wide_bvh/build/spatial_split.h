#pragma once
/// Builds a binary bounding volume hierarchy by the surface area heuristic with spatial splits: if
/// long primitives make boxes overlap, a plane divides the cell, and primitives on both sides are
/// referenced on both.
///
/// Source: Stich, Friedrich and Dietrich, "Spatial Splits in Bounding Volume Hierarchies", HPG
/// 2009.
/// Differs: the number of references is bounded in advance, in proportion to the size of each
/// subtree, so that the tree is built in place and in parallel; primitives of kinds that cannot be
/// divided stay whole; planes are evaluated with parts cut in float; after several failed searches
/// more and more levels are skipped, which bounds the time for any input.
/// Conventions: a primitive may lie in several leaves; every point of it lies in the box of one.
/// Complexity and threads: O(n log n), parallel; the result is the same for every number of
/// threads.

#include <vector>

#include "alhazen/accel/wide_bvh/build/sah_split.h"

namespace alhazen {

/// Equidistant planes along an axis of a box, and the bins between them.
struct BinPlanes {
    int axis, bins;
    float lo, step, per_step;

    BinPlanes(const Box4& box, int of_axis, int count)
        : axis(of_axis),
          bins(count),
          lo(box.lo[of_axis]),
          step((box.hi[of_axis] - box.lo[of_axis]) / static_cast<float>(count)),
          per_step(1 / step) {}
    /// The plane below bin i.
    [[nodiscard]] float operator()(int i) const { return lo + static_cast<float>(i) * step; }
    [[nodiscard]] int bin(float x) const {
        const float place = (x - lo) * per_step;
        // Written so that NaN falls into the first bin.
        if (!(place > 0)) return 0;
        return place < static_cast<float>(bins - 1) ? static_cast<int>(place) : bins - 1;
    }
    [[nodiscard]] bool usable() const { return lo + step > lo && step > 1e-30f; }
};

/// Divides primitives for the builder, which has no access to them.
class ReferenceSplitter {
  public:
    virtual ~ReferenceSplitter() = default;
    [[nodiscard]] virtual bool can_split(std::uint32_t kind) const = 0;
    /// Boxes, within that of `reference`, that contain the points of its primitive there, below and
    /// above the plane; empty if there are none. Must be thread-safe.
    virtual void split(const BuildReference& reference, int axis, float plane, FloatBox& below,
                       FloatBox& above) const = 0;
    /// Approximate boxes of its parts in the bins from `first` to `last`, one per bin; empty if it
    /// has no part there. For costs only, so rounding is irrelevant. Must be thread-safe.
    virtual void slice(const BuildReference& reference, const BinPlanes& planes, int first,
                       int last, Box4* slices) const;
};

/// Maximum growth of the number of references.
inline constexpr double kSpatialSplitBudget = 1.3;

/// As build_binary, but `references` grows, and only nodes that fit into one block have a range of
/// them: there are gaps between the others.
[[nodiscard]] BinaryBvh build_with_spatial_splits(std::vector<BuildReference>& references,
                                                  const LeafKinds& kinds,
                                                  const ReferenceSplitter& splitter);

}  // namespace alhazen
