#pragma once
/// Traces the outlines of a region of an arrangement and writes them as a canonical set.
///
/// Conventions: at a point where several outlines meet, each continues along the edge that bounds
/// the same corner of the interior; a loop that returns to a point is split there. So loops are
/// simple, pieces of the interior that touch in a point are separate loops, and so are holes that
/// touch their outline.
/// Complexity: O(m) for m sub-edges, O(d log d) at a point with d edges, O(m log m) if rounding
/// makes sub-edges overlap.

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
    /// Rounds the points. `arrangement` must outlive the tracer's use.
    void prepare(const Arrangement& arrangement);

    /// Traces the region of the points whose state s has inside[s].
    using States = std::array<bool, 4>;
    void trace(const States& inside, PolygonSet& region);

    /// The rounded points that a sub-edge passes through, in its order. Valid until the next call.
    [[nodiscard]] std::span<const std::uint32_t> way_of(const SubEdge& sub_edge);
    /// Traces the region to the left of links between points. Precondition: the links are of ways
    /// of sub-edges, and `way_of` was called for all of them.
    void trace(std::span<const std::pair<std::uint32_t, std::uint32_t>> links, PolygonSet& region);

    /// Number of points at which more than one outline of the last region met.
    [[nodiscard]] std::size_t touches() const { return touches_; }

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// A piece of the outline; the region lies to its left.
    struct Link {
        std::uint32_t from = 0;
        std::uint32_t to = 0;
        std::uint32_t next = kNone;  ///< first: next link from `from`; then: the link after it
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
    std::vector<std::uint32_t> leaving_;  ///< [point] one link that leaves it
    std::vector<std::uint32_t> path_;     ///< points of the loop being traced
    std::vector<std::uint32_t> where_;    ///< [point] its index in the path
    std::vector<Ray> rays_;
    std::vector<std::uint32_t> fans_;   ///< links that arrive at points where outlines meet
    std::vector<std::uint32_t> after_;  ///< [link] the one after it
    std::vector<LatticePoint> points_;  ///< of all loops
    std::vector<std::pair<std::uint32_t, std::uint32_t>> loops_;  ///< ranges in points_
    std::size_t touches_ = 0;
};

}  // namespace alhazen
