#pragma once
/// Walks the outlines of a region of an arrangement and writes them as a canonical set.
///
/// Conventions: at a point where several outlines meet, each goes on along the edge that bounds the
/// same corner of the interior; a loop that comes back to a point is cut there. So loops are
/// simple, pieces of the interior that touch in a point are loops of their own, and so are holes
/// that touch their outline.
/// Complexity: O(m) for m sub-edges, O(d log d) at a point with d edges, O(m log m) where sub-edges
/// came to lie on each other.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "alhazen/geometry/polygon_sets/arrangement.h"
#include "alhazen/geometry/polygon_sets/polygon_set.h"
#include "alhazen/geometry/polygon_sets/snap_rounding.h"

namespace alhazen {

class RegionTracer {
  public:
    /// Rounds the points. `arrangement` has to live on.
    void prepare(const Arrangement& arrangement);

    /// The region of the states s with inside[s].
    using States = std::array<bool, 4>;
    void trace(const States& inside, PolygonSet& region);

    /// The points that a sub-edge leads through, rounded, in its order. Valid until the next call.
    [[nodiscard]] std::span<const std::uint32_t> way_of(const SubEdge& sub_edge);
    /// The region on the left of links from point to point, which are of ways of sub-edges; all
    /// ways have been asked for before.
    void trace(std::span<const std::pair<std::uint32_t, std::uint32_t>> links, PolygonSet& region);

    /// Points at which more than one outline of the last region met.
    [[nodiscard]] std::size_t touches() const { return touches_; }

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// A piece of the outline, the region on its left.
    struct Link {
        std::uint32_t from = 0;
        std::uint32_t to = 0;
        std::uint32_t next = kNone;  ///< first: the next that leaves `from`; then: the one after it
        bool visited = false;
    };
    /// An edge at a point where outlines meet, seen from the point.
    struct Ray {
        LatticePoint tip;
        std::uint32_t link = 0;
        bool leaves = false;
    };

    void trace_links(PolygonSet& region);
    void collect_links(const States& inside);
    void cancel_links();
    void connect_links();
    void connect_fan(std::uint32_t point, std::span<const std::uint32_t> arriving);
    void connect_fans();
    void walk(std::uint32_t first);
    void take_loop(std::size_t begin);
    void write(PolygonSet& region);

    const Arrangement* arrangement_ = nullptr;
    SnapRounding rounding_;
    std::vector<Link> links_;
    std::vector<std::uint32_t> way_;
    std::vector<std::uint32_t> leaving_;  ///< of each point, one link that leaves it
    std::vector<std::uint32_t> path_;     ///< points of the loop in the making
    std::vector<std::uint32_t> where_;    ///< of each point, its place in the path
    std::vector<Ray> rays_;
    std::vector<std::uint32_t> fans_;   ///< links that arrive at points where outlines meet
    std::vector<std::uint32_t> after_;  ///< of each link, the one after it
    std::vector<LatticePoint> points_;  ///< of all loops
    std::vector<std::pair<std::uint32_t, std::uint32_t>> loops_;  ///< begin and end in points_
    std::size_t touches_ = 0;
};

}  // namespace alhazen
