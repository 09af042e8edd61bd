#pragma once
/// The evaluator for solids of a few leaves, such as a sphere with a hole in it: no tree of boxes
/// and no heap. The event heap leaves such solids to it.
///
/// Source: Roth, "Ray Casting for Modeling Solids", CGIP 18, 1982 (classification along a ray).
/// Differs: which leaves a place is inside of is a number of so many bits, and whether a node of
/// the expression is true there is looked up in a table with a bit for each such number. All
/// crossings lie in one sorted list; a ray that misses a leaf without which there is nothing (what
/// a difference takes from, an operand of an intersection) is done. Conventions: the transitions of
/// csg_solid.h, the bits of the event heap. Leaves must be analytic shapes that cross a line no
/// more than kMaxShapeHits times, and there is one medium. Eight rays at a time go to csg_lanes.h
/// where the leaves are convex shapes that it knows. Threads: const functions may be called from
/// many threads.

#include <array>

#include "alhazen/csg/csg_evaluator.h"
#include "alhazen/csg/csg_lanes.h"

namespace alhazen {

class CsgTruthTable final : public LaneSolid, public CsgEvaluator {
  public:
    static constexpr std::uint32_t kMaxLeaves = 6;  ///< a table has 2^6 bits
    static constexpr std::uint32_t kMaxNodes = 8;

    [[nodiscard]] static bool fits(const CsgSolid& solid);
    /// Precondition: it fits.
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
    /// A bit for each leaf that a place is inside of.
    using LeafSet = std::uint32_t;
    class Events;

    [[nodiscard]] bool is_solid(LeafSet inside) const { return (tables_[0] >> inside & 1) != 0; }
    /// Where a leaf lies in the table of primitives.
    struct Place {
        std::uint32_t kind = 0, index = 0;
    };

    /// The crossings of the line with a leaf.
    struct Crossings {
        int count = 0;
        bool inside = false;  ///< where the line begins
    };

    /// Where all leaves are convex shapes that lanes know, which stand in the frame of the solid.
    void prepare_lanes();
    [[nodiscard]] bool has_huge_leaf() const;
    void set_shape(const Place& place, CsgLanesSolid::Leaf& leaf) const;
    /// As `closest_of_lanes`, one ray after the other.
    std::uint32_t closest_of_each(const RayLanes& rays, std::uint32_t wanted, LaneHits& hits,
                                  RayQuery query) const;
    Crossings cross(std::uint32_t leaf, const CsgRay& ray, ShapeHit* hits,
                    TraversalStats* stats) const;
    bool gather(const CsgRay& ray, Events& events, TraversalStats* stats) const;
    bool next(const CsgRay& ray, Events& events, CsgCrossing& found) const;
    [[nodiscard]] bool changes_all_the_way(std::uint32_t leaf, LeafSet before, LeafSet after) const;
    [[nodiscard]] std::uint32_t filling_leaf(LeafSet inside) const;
    void fill(const CsgCrossing& crossing, Hit& hit) const;

    // What lanes need comes first, together.
    decltype(CsgLanesKernel::first) first_in_lanes_ = nullptr;  ///< where lanes know all leaves
    CsgLanesSolid lanes_;
    const CsgSolid& solid_;
    std::array<Place, kMaxLeaves> places_{};
    std::array<std::uint64_t, kMaxNodes>
        tables_{};  ///< [node] bit i: its value inside of LeafSet i
    /// Leaves without which the solid is empty first.
    std::array<std::uint32_t, kMaxLeaves> order_{};
    LeafSet needed_ = 0;  ///< these
};

}  // namespace alhazen
