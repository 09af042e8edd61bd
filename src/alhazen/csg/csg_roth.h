#pragma once
/// The classical evaluator: merges the crossings of a ray with every leaf, bottom-up.
///
/// Source: Roth, "Ray Casting for Modeling Solids", Computer Graphics and Image Processing 18,
/// 1982: each operator classifies the merged crossings of its two sides by its table (Foley, van
/// Dam et al., "Computer Graphics", table 15.2); where the left side is empty an intersection or
/// difference skips the right one; a node whose box the ray misses is empty.
/// Differs: (1) an operator of many operands is applied pairwise; (2) crossings at the same t are
/// classified together, so that faces that coincide exactly leave nothing between them; (3) a ray
/// may start inside: each list stores whether it does; (4) a query for any transition takes as long
/// as one for the first, because nothing may follow the start of a ray inside; (5) boundaries
/// between media in one solid, which span lists do not represent, are found by the event heap
/// without bounds; (6) transitions closer than tau are one, as csg_solid.h defines them.
/// Complexity and threads: O(sum of the crossings of all leaves x depth) per ray. Const functions
/// may be called from many threads.

#include "alhazen/csg/csg_event_heap.h"

namespace alhazen {

class CsgRoth final : public CsgEvaluator {
  public:
    static constexpr const char* kName = "roth";
    static constexpr const char* kDescription = "span lists merged bottom-up (Roth 1982)";

    explicit CsgRoth(const CsgSolid& solid);

    bool first(const CsgRay& ray, Hit& hit, TraversalStats* stats) const override;
    bool all(const CsgRay& ray, std::vector<Hit>& hits, TraversalStats* stats) const override;
    [[nodiscard]] CsgSides sides(const CsgRay& ray, double t) const override {
        return sweep_.sides(ray, t);
    }
    [[nodiscard]] std::size_t memory_bytes() const override {
        return boxes_.capacity() * sizeof(Box3) + leaf_boxes_.capacity() * sizeof(Box3);
    }

  private:
    const CsgSolid& solid_;
    std::vector<Box3> boxes_;       ///< [node] box of the operator's result
    std::vector<Box3> leaf_boxes_;  ///< [leaf]
    CsgEventHeap sweep_;            ///< tests every leaf for every ray
};

}  // namespace alhazen
