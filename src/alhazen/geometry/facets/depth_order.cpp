#include "alhazen/geometry/facets/depth_order.h"

#include <algorithm>
#include <list>

#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

struct DepthItem {
    FacetPiece piece;
    double near, far;
    double lo_x, hi_x, lo_y, hi_y;  ///< in the window; infinite if the polygon reaches the apex
    bool moved = false;
};

class DepthSorter {
  public:
    DepthSorter(FacetPool& pool, const BeamApex& apex, const BeamProjection& projection,
                double margin, DepthOrderReport& report)
        : pool_(pool), apex_(apex), projection_(projection), margin_(margin), report_(report) {}

    void add(const FacetPiece& piece) { insert(item_of(piece)); }

    std::vector<FacetPiece> sorted() {
        std::vector<FacetPiece> order;
        items_.sort([](const DepthItem& a, const DepthItem& b) { return a.near < b.near; });
        while (!items_.empty()) {
            if (!settle_first()) continue;
            order.push_back(items_.front().piece);
            items_.pop_front();
        }
        return order;
    }

  private:
    [[nodiscard]] DepthItem item_of(const FacetPiece& piece) const {
        DepthItem item{piece, kInfinity, -kInfinity, kInfinity, -kInfinity, kInfinity, -kInfinity};
        for (const Vec3& p : pool_.corners(piece)) {
            const Vec3 w = projection_(p);
            const double depth = depth_of(p);
            item.near = std::min(item.near, depth);
            item.far = std::max(item.far, depth);
            const bool before = w.z > 0.0;
            item.lo_x = before ? std::min(item.lo_x, w.x / w.z) : -kInfinity;
            item.hi_x = before ? std::max(item.hi_x, w.x / w.z) : kInfinity;
            item.lo_y = before ? std::min(item.lo_y, w.y / w.z) : -kInfinity;
            item.hi_y = before ? std::max(item.hi_y, w.y / w.z) : kInfinity;
        }
        return item;
    }
    [[nodiscard]] double depth_of(const Vec3& p) const {
        return apex_.weight != 0.0 ? projection_.row(2, p) : -dot(p, apex_.at);
    }
    void insert(const DepthItem& item) {
        auto at = items_.begin();
        if (!items_.empty() && started_) {
            while (at != items_.end() && at->near < item.near) ++at;
        }
        items_.insert(at, item);
    }

    /// True if no later polygon hides a part of the first one; otherwise moves another one to the
    /// front, or splits one.
    bool settle_first() {
        started_ = true;
        const auto first = items_.begin();
        for (auto other = std::next(first); other != items_.end(); ++other) {
            if (other->near > first->far) continue;
            ++report_.compared;
            if (may_precede(*first, *other)) continue;
            if (!other->moved && may_precede(*other, *first)) {
                other->moved = true;
                items_.splice(items_.begin(), items_, other);
                return false;
            }
            if (split(first, other) || split_by_third(first)) return false;
        }
        return true;
    }

    [[nodiscard]] bool may_precede(const DepthItem& a, const DepthItem& b) const {
        if (a.hi_x < b.lo_x || b.hi_x < a.lo_x || a.hi_y < b.lo_y || b.hi_y < a.lo_y) return true;
        const FacetPlane of_a = towards_apex(a.piece.facet), of_b = towards_apex(b.piece.facet);
        const SideRange b_to_a = side_range(of_a, pool_.corners(b.piece));
        // Of polygons in one plane the one of lower index hides the other.
        const bool in_plane = b_to_a.most <= margin_ && b_to_a.least >= -margin_;
        const bool behind = in_plane
                                ? a.piece.facet <= b.piece.facet
                                : b_to_a.most <= margin_ ||
                                      side_range(of_b, pool_.corners(a.piece)).least >= -margin_;
        return behind || edge_parts(a.piece, b.piece) || edge_parts(b.piece, a.piece);
    }
    [[nodiscard]] FacetPlane towards_apex(std::uint32_t facet) const {
        const FacetPlane& plane = pool_.planes[facet];
        return apex_.side(plane) >= 0.0 ? plane : plane.reversed();
    }

    /// The plane through the apex and an edge.
    [[nodiscard]] FacetPlane edge_plane(std::span<const Vec3> loop, std::size_t k) const {
        const Vec3 &a = loop[k], &b = loop[k + 1 == loop.size() ? 0 : k + 1];
        const Vec3 n = cross(b - a, apex_.at - apex_.weight * a);
        const double size = length(n);
        return size > 0.0 ? FacetPlane{n / size, dot(n, a) / size} : FacetPlane{};
    }
    /// True if an edge of `a` separates the two as seen from the apex.
    [[nodiscard]] bool edge_parts(const FacetPiece& a, const FacetPiece& b) const {
        const std::span<const Vec3> loop = pool_.corners(a);
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const FacetPlane plane = edge_plane(loop, k);
            const SideRange own = side_range(plane, loop);
            const SideRange other = side_range(plane, pool_.corners(b));
            if (own.most > margin_ && other.most <= margin_) return true;
            if (own.least < -margin_ && other.least >= -margin_) return true;
        }
        return false;
    }

    /// Splits one by the plane of the other; if neither crosses, in a cycle of three or more, by a
    /// plane through the apex.
    bool split(std::list<DepthItem>::iterator first, std::list<DepthItem>::iterator other) {
        return split_by(pool_.planes[first->piece.facet], other) ||
               split_by(pool_.planes[other->piece.facet], first) ||
               split_by_edges(pool_.corners(other->piece), first) ||
               split_by_edges(pool_.corners(first->piece), other);
    }
    /// Splits if two polygons of a cycle hide each other as a whole, by a third one of the cycle.
    bool split_by_third(std::list<DepthItem>::iterator first) {
        for (auto third = std::next(first); third != items_.end(); ++third) {
            if (may_precede(*third, *first)) continue;
            if (split_by_edges(pool_.corners(third->piece), first) ||
                split_by_edges(pool_.corners(first->piece), third)) {
                return true;
            }
        }
        return false;
    }
    bool split_by_edges(std::span<const Vec3> loop, std::list<DepthItem>::iterator item) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
            if (split_by(edge_plane(loop, k), item)) return true;
        }
        return false;
    }
    bool split_by(const FacetPlane& plane, std::list<DepthItem>::iterator item) {
        split_loop(plane, margin_, pool_.corners(item->piece), before_, behind_);
        const SideRange range = side_range(plane, pool_.corners(item->piece));
        if (range.most <= margin_ || range.least >= -margin_) return false;
        const std::uint32_t facet = item->piece.facet;
        items_.erase(item);
        ++report_.splits;
        for (const std::vector<Vec3>* loop : {&before_, &behind_}) {
            if (!loop->empty()) insert(item_of(pool_.add(facet, *loop)));
        }
        return true;
    }

    FacetPool& pool_;
    const BeamApex& apex_;
    const BeamProjection& projection_;
    double margin_;
    DepthOrderReport& report_;
    std::list<DepthItem> items_;
    bool started_ = false;
    std::vector<Vec3> before_, behind_;
};

}  // namespace

std::vector<FacetPiece> depth_order(FacetPool& pool, std::span<const FacetPiece> polygons,
                                    const BeamApex& apex, const BeamProjection& projection,
                                    const BeamSides& sides, double margin,
                                    DepthOrderReport& report) {
    DepthSorter sorter(pool, apex, projection, margin, report);
    report.polygons += polygons.size();
    for (const FacetPiece& piece : polygons) {
        if (misses(pool.corners(piece), sides, margin)) continue;
        ++report.within;
        sorter.add(piece);
    }
    return sorter.sorted();
}

}  // namespace alhazen
