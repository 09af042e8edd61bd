#pragma once
/// The evaluator for solids of any size: tests only leaves whose S-bounds the ray meets, front to
/// back, and stops at the first requested transition.
///
/// Source: Cameron, "Efficient Bounds in Constructive Solid Geometry", IEEE CG&A 11(3), 1991
/// (S-bounds); Roth, "Ray Casting for Modeling Solids", CGIP 18, 1982 (classification along a ray);
/// Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (heap of bounds).
/// Differs: one tree of boxes over the S-bounds of all leaves, for all operators. Crossings wait in
/// a second heap until every bound in front of them is opened. The state of the solid is stored as
/// counts of true operands and updated from the leaf upward, only as far as it changes. Where one
/// operand alone determines the value (a ray inside a hole), bounds that begin and end there stay
/// unopened, and others are opened where it ends: active zones of Rossignac and Voelcker, "Active
/// Zones in CSG for Accelerating Boundary Evaluation", ACM TOG 8(1), 1989, found along the ray.
/// Outside its S-bound a leaf counts as outside; docs/design/csg.md shows that this does not change
/// the solid, and tests compare it with the evaluation of every leaf.
/// Complexity and threads: O(k log k) for k leaves pierced before the transition, and the paths to
/// them in the tree of boxes. No allocation per ray in a steady state. Const functions may be
/// called from many threads.

#include "alhazen/csg/csg_bvh.h"
#include "alhazen/csg/csg_evaluator.h"

namespace alhazen {

class CsgEventHeap final : public CsgEvaluator {
  public:
    static constexpr const char* kName = "event_heap";
    static constexpr const char* kDescription =
        "S-bounds in a tree of boxes, heap of crossings (table for a few leaves): for any size";

    explicit CsgEventHeap(const CsgSolid& solid) : CsgEventHeap(solid, solid.tree().bounds()) {}
    /// Uses the given bounds, which must contain the S-bounds.
    CsgEventHeap(const CsgSolid& solid, std::span<const Box3> bounds)
        : solid_(solid), bvh_(bounds) {}

    bool first(const CsgRay& ray, Hit& hit, TraversalStats* stats) const override;
    bool all(const CsgRay& ray, std::vector<Hit>& hits, TraversalStats* stats) const override;
    [[nodiscard]] CsgSides sides(const CsgRay& ray, double t) const override;
    [[nodiscard]] std::size_t memory_bytes() const override { return bvh_.memory_bytes(); }

  private:
    const CsgSolid& solid_;
    CsgBvh bvh_;
};

}  // namespace alhazen
