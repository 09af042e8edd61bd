#include "alhazen/geometry/facets/point_hull.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "alhazen/geometry/facets/facet_pool.h"
#include "alhazen/geometry/polygon/convex_outline.h"

namespace alhazen {

namespace {

/// Number of points up to which they are kept as they are.
constexpr std::size_t kFewPoints = 10;
constexpr double kFlatHull = 1e-11;

bool comes_before(const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

struct HullFace {
    std::array<std::uint32_t, 3> corners;
    FacetPlane plane;  ///< outward unit normal
};

/// Adds points to a hull, one by one.
class HullMaker {
  public:
    HullMaker(const std::vector<Vec3>& points, double extent)
        : points_(points), margin_(kFlatHull * extent) {}

    /// False if the points lie in a plane, or rounding made the result invalid.
    bool make() {
        if (!begin()) return false;
        // A stride prime to the count visits all points, far apart from each other.
        const std::size_t count = points_.size();
        std::size_t stride = count / 3 * 2 + 1;
        while (std::gcd(stride, count) != 1) ++stride;
        for (std::size_t k = 0, at = 0; k < count; ++k, at = (at + stride) % count) {
            if (!add(static_cast<std::uint32_t>(at))) return false;
        }
        return holds_all();
    }
    [[nodiscard]] const std::vector<HullFace>& faces() const { return faces_; }
    [[nodiscard]] std::vector<Vec3> corners() const {
        std::vector<bool> used(points_.size());
        for (const HullFace& face : faces_) {
            for (const std::uint32_t c : face.corners) used[c] = true;
        }
        std::vector<Vec3> result;
        for (std::size_t k = 0; k < points_.size(); ++k) {
            if (used[k]) result.push_back(points_[k]);
        }
        return result;
    }

  private:
    [[nodiscard]] HullFace face(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        const Vec3 n = cross(points_[b] - points_[a], points_[c] - points_[a]);
        const double size = length(n);
        const Vec3 unit = size > 0.0 ? n / size : Vec3{};
        return {{a, b, c}, {unit, dot(unit, points_[a])}};
    }

    template <class Measure>
    [[nodiscard]] std::uint32_t farthest(Measure&& measure) const {
        std::uint32_t best = 0;
        for (std::uint32_t k = 1; k < points_.size(); ++k) {
            if (measure(points_[k]) > measure(points_[best])) best = k;
        }
        return best;
    }

    bool begin() {
        const std::uint32_t a = 0;  // the least
        const std::uint32_t b =
            farthest([&](const Vec3& p) { return length_squared(p - points_[a]); });
        const Vec3 along = points_[b] - points_[a];
        const std::uint32_t c =
            farthest([&](const Vec3& p) { return length_squared(cross(along, p - points_[a])); });
        const HullFace base = face(a, b, c);
        const std::uint32_t d = farthest([&](const Vec3& p) { return std::abs(base.plane.at(p)); });
        const double height = base.plane.at(points_[d]);
        if (!(std::abs(height) > 100 * margin_)) return false;
        const auto [p, q] = height > 0.0 ? std::pair{c, b} : std::pair{b, c};
        faces_ = {face(a, p, q), face(p, a, d), face(q, p, d), face(a, q, d)};
        return true;
    }

    bool add(std::uint32_t point) {
        edges_.clear();
        std::size_t kept = 0;
        for (std::size_t k = 0; k < faces_.size(); ++k) {
            const HullFace& f = faces_[k];
            if (f.plane.at(points_[point]) > margin_) {
                for (std::size_t i = 0; i < 3; ++i) {
                    edges_.push_back({f.corners[i], f.corners[(i + 1) % 3]});
                }
            } else {
                faces_[kept++] = f;
            }
        }
        if (edges_.empty()) return true;
        if (kept == 0) return false;
        faces_.resize(kept);
        for (const auto& [a, b] : edges_) {
            // A linear search: a point sees few faces.
            if (std::find(edges_.begin(), edges_.end(), std::pair{b, a}) == edges_.end()) {
                faces_.push_back(face(a, b, point));
            }
        }
        return true;
    }

    [[nodiscard]] bool holds_all() const {
        for (const HullFace& f : faces_) {
            if (side_range(f.plane, points_).most > 50 * margin_) return false;
        }
        std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
        for (const HullFace& f : faces_) {
            for (std::size_t i = 0; i < 3; ++i) {
                edges.push_back({f.corners[i], f.corners[(i + 1) % 3]});
            }
        }
        std::sort(edges.begin(), edges.end());
        return std::adjacent_find(edges.begin(), edges.end()) == edges.end() &&
               std::all_of(edges.begin(), edges.end(), [&](const auto& e) {
                   return std::binary_search(edges.begin(), edges.end(),
                                             std::pair{e.second, e.first});
               });
    }

    const std::vector<Vec3>& points_;
    double margin_;
    std::vector<HullFace> faces_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;
};

struct Extent {
    Vec3 lo, hi;
    [[nodiscard]] double size() const { return max_component(hi - lo); }
};

Extent extent_of(const std::vector<Vec3>& points) {
    Extent e{points[0], points[0]};
    for (const Vec3& p : points) {
        for (int k = 0; k < 3; ++k) {
            e.lo[k] = std::min(e.lo[k], p[k]);
            e.hi[k] = std::max(e.hi[k], p[k]);
        }
    }
    return e;
}

std::vector<Vec3> box_corners(const Extent& e) {
    std::vector<Vec3> corners;
    for (int k = 0; k < 8; ++k) {
        corners.push_back({(k & 1) != 0 ? e.hi.x : e.lo.x, (k & 2) != 0 ? e.hi.y : e.lo.y,
                           (k & 4) != 0 ? e.hi.z : e.lo.z});
    }
    return corners;
}

/// The hull of points in a plane; empty if they lie in none.
std::vector<Vec3> flat_hull(const std::vector<Vec3>& points, double extent) {
    Vec3 n;
    for (std::size_t k = 2; k < points.size(); ++k) {
        const Vec3 c = cross(points[1] - points[0], points[k] - points[0]);
        if (length_squared(c) > length_squared(n)) n = c;
    }
    if (!(length(n) > 1e-6 * extent * extent)) return {};
    n = normalize(n);
    const FacetPlane plane{n, dot(n, points[0])};
    const SideRange range = side_range(plane, points);
    if (range.most - range.least > 1e-10 * extent) return {};
    const int c = dominant_axis(n), a = (c + 1) % 3, b = (c + 2) % 3;
    std::vector<Vec2> flat;
    for (const Vec3& p : points) flat.push_back({p[a], p[b]});
    std::vector<Vec3> result;
    for (const Vec2& p : convex_outline(std::move(flat))) {
        Vec3 corner;
        corner[a] = p.x;
        corner[b] = p.y;
        corner[c] = (plane.offset - n[a] * p.x - n[b] * p.y) / n[c];
        result.push_back(corner);
    }
    return result;
}

/// The corners of the polytope of 26 planes around points; empty if that fails.
std::vector<Vec3> polytope_around(const std::vector<Vec3>& points, const Extent& e) {
    const Vec3 middle = 0.5 * (e.lo + e.hi);
    std::vector<Vec3> duals;
    for (int k = 0; k < 27; ++k) {
        if (k == 13) continue;
        const Vec3 n = normalize(Vec3{double(k % 3 - 1), double(k / 3 % 3 - 1), double(k / 9 - 1)});
        const double reach = side_range({n, dot(n, middle)}, points).most;
        if (!(reach > 1e-6 * e.size())) return {};
        duals.push_back(n / (reach * (1.0 + 1e-10)));
    }
    std::sort(duals.begin(), duals.end(), comes_before);
    const double size = extent_of(duals).size();
    HullMaker maker(duals, size);
    if (!maker.make()) return {};
    std::vector<Vec3> corners;
    for (const HullFace& face : maker.faces()) {
        if (!(face.plane.offset > 1e-9 * size)) return {};
        corners.push_back(middle + face.plane.normal / face.plane.offset);
    }
    std::sort(corners.begin(), corners.end(), comes_before);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
}

}  // namespace

void reduce_to_hull(std::vector<Vec3>& points, std::size_t most) {
    std::sort(points.begin(), points.end(), comes_before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() <= kFewPoints) return;
    const Extent extent = extent_of(points);
    std::vector<Vec3> corners;
    if (points.size() <= most + most / 4) {
        HullMaker maker(points, extent.size());
        corners = maker.make() ? maker.corners() : flat_hull(points, extent.size());
    }
    if (corners.empty() || corners.size() > most) corners = polytope_around(points, extent);
    points = corners.empty() ? box_corners(extent) : std::move(corners);
}

}  // namespace alhazen
