#pragma once
/// The evaluator for solids of a few leaves, such as a sphere with a hole, without a tree of boxes
/// or a heap. The event heap delegates these solids to it.
///
/// Source: Roth, "Ray Casting for Modeling Solids", CGIP 18, 1982 (classification along a ray).
/// Differs: the set of leaves that contain a point is a bit set, and the value of a node of the
/// expression is looked up in a table with one bit per set. All crossings are in one sorted list; a
/// ray that misses a needed leaf (the minuend of a difference, an operand of an intersection) is
/// finished at once.
/// Conventions: the transitions of csg_solid.h, bit-identical to those of the event heap. Leaves
/// must be analytic shapes with at most kMaxShapeHits crossings per line, and there is one medium.
/// Rays are passed to csg_lanes.h, eight at a time, if it supports all leaves (convex shapes).
/// Threads: const functions may be called from many threads.

#include <array>

#include "alhazen/csg/csg_evaluator.h"
#include "alhazen/csg/csg_lanes.h"

namespace alhazen {

class CsgTruthTable final : public LaneSolid, public CsgEvaluator {
  public:
    static constexpr std::uint32_t kMaxLeaves = 6;  ///< a table has 2^6 bits
    static constexpr std::uint32_t kMaxNodes = 8;

    [[nodiscard]] static bool fits(const CsgSolid& solid);
    /// Precondition: fits(solid).
    explicit CsgTruthTable(const CsgSolid& solid);

    bool first(const CsgRay& ray, Hit& hit, TraversalStats* stats) const override;
    bool all(const CsgRay& ray, std::vector<Hit>& hits, TraversalStats* stats) const override;
    [[nodiscard]] const LaneSolid* lane_solid() const override {
        return first_in_lanes_ != nullptr ? this : nullptr;
    }
    std::uint32_t closest_of_lanes(const RayLanes& rays, std::uint32_t wanted, LaneHits& hits,
                                   RayQuery query) const override;
    [[nodiscard]] CsgSides sides(const CsgRay& ray, double t) const override;
    [[nodiscard]] std::size_t memory_bytes() const override { return sizeof(*this); }

  private:
    /// One bit for each leaf that contains a point.
    using LeafSet = std::uint32_t;
    class Events;

    [[nodiscard]] bool is_solid(LeafSet inside) const { return (tables_[0] >> inside & 1) != 0; }
    /// The position of a leaf in the table of primitives.
    struct Place {
        std::uint32_t kind = 0, index = 0;
    };

    /// The crossings of a line with a leaf.
    struct Crossings {
        int count = 0;
        bool inside = false;  ///< where the line starts
    };

    /// Sets up the data of the lanes, in the frame of the solid, if they support all leaves.
    void prepare_lanes();
    [[nodiscard]] bool has_huge_leaf() const;
    void set_shape(const Place& place, CsgLanesSolid::Leaf& leaf) const;
    /// `closest_of_lanes` ray by ray.
    std::uint32_t closest_of_each(const RayLanes& rays, std::uint32_t wanted, LaneHits& hits,
                                  RayQuery query) const;
    Crossings cross(std::uint32_t leaf, const CsgRay& ray, ShapeHit* hits,
                    TraversalStats* stats) const;
    bool gather(const CsgRay& ray, Events& events, TraversalStats* stats) const;
    bool next(const CsgRay& ray, Events& events, CsgCrossing& found) const;
    [[nodiscard]] bool changes_all_the_way(std::uint32_t leaf, LeafSet before, LeafSet after) const;
    [[nodiscard]] std::uint32_t filling_leaf(LeafSet inside) const;
    void fill(const CsgCrossing& crossing, Hit& hit) const;

    // The data of the lanes is first and contiguous.
    /// Null if lanes do not support all leaves.
    decltype(CsgLanesKernel::first) first_in_lanes_ = nullptr;
    CsgLanesSolid lanes_;
    const CsgSolid& solid_;
    std::array<Place, kMaxLeaves> places_{};
    std::array<std::uint64_t, kMaxNodes> tables_{};  ///< [node] bit i: its value for LeafSet i
    /// The leaves in the order of tests: needed leaves (without which the solid is empty) first.
    std::array<std::uint32_t, kMaxLeaves> order_{};
    LeafSet needed_ = 0;  ///< the needed leaves
};

}  // namespace alhazen
