#include "alhazen/geometry/polygon/free_diagonals.h"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>

#include "alhazen/geometry/polygon/merged_positions.h"

namespace alhazen {

namespace {

using CornerTriple = std::array<std::uint32_t, 3>;
/// An edge between merged vertices, the lower index in the upper bits.
using EdgeKey = std::uint64_t;

class DiagonalTurner {
  public:
    DiagonalTurner(std::span<const Vec3> positions, std::span<const PolygonTriangles> polygons,
                   std::vector<CornerTriple>& triangles)
        : positions_(positions),
          polygons_(polygons),
          triangles_(triangles),
          merged_(merged_positions(positions)) {}

    std::size_t run() {
        collect_diagonals();
        count_diagonals();
        if (crowded_.empty()) return 0;
        std::size_t turned = 0;
        std::vector<EdgeKey> own;
        for (const PolygonTriangles& polygon : polygons_) {
            diagonals_of(polygon, own);
            for (const EdgeKey diagonal : own) {
                if (std::binary_search(crowded_.begin(), crowded_.end(), diagonal)) {
                    turned += turn(polygon, diagonal) ? 1 : 0;
                }
            }
        }
        return turned;
    }

  private:
    [[nodiscard]] EdgeKey key(std::uint32_t from, std::uint32_t to) const {
        const auto [lo, hi] = std::minmax(merged_[from], merged_[to]);
        return EdgeKey{lo} << 32 | hi;
    }
    [[nodiscard]] EdgeKey edge(const CornerTriple& triangle, std::size_t k) const {
        return key(triangle[k], triangle[(k + 1) % 3]);
    }

    /// The edges of exactly two triangles of the polygon.
    void diagonals_of(const PolygonTriangles& polygon, std::vector<EdgeKey>& diagonals) {
        edges_.clear();
        for (std::size_t i = polygon.begin; i < polygon.end; ++i) {
            for (std::size_t k = 0; k < 3; ++k) edges_.push_back(edge(triangles_[i], k));
        }
        std::sort(edges_.begin(), edges_.end());
        diagonals.clear();
        for (std::size_t i = 0; i < edges_.size();) {
            std::size_t end = i;
            while (end < edges_.size() && edges_[end] == edges_[i]) ++end;
            if (end - i == 2) diagonals.push_back(edges_[i]);
            i = end;
        }
    }

    void collect_diagonals() {
        std::vector<EdgeKey> own;
        for (const PolygonTriangles& polygon : polygons_) {
            diagonals_of(polygon, own);
            diagonals_.insert(diagonals_.end(), own.begin(), own.end());
        }
        std::sort(diagonals_.begin(), diagonals_.end());
        diagonals_.erase(std::unique(diagonals_.begin(), diagonals_.end()), diagonals_.end());
    }

    /// Finds the diagonals that are edges of more than two triangles.
    void count_diagonals() {
        // A filter excludes most other edges from the search.
        const std::size_t bits = std::bit_ceil(16 * diagonals_.size() + 64);
        const int shift = 64 - std::countr_zero(bits);
        const auto slot = [&](EdgeKey key) {
            return std::size_t((key * 0x9E3779B97F4A7C15u) >> shift);
        };
        std::vector<bool> filter(bits, false);
        for (const EdgeKey diagonal : diagonals_) filter[slot(diagonal)] = true;
        std::vector<std::uint8_t> counts(diagonals_.size(), 0);
        for (const CornerTriple& triangle : triangles_) {
            for (std::size_t k = 0; k < 3; ++k) {
                const EdgeKey e = edge(triangle, k);
                if (!filter[slot(e)]) continue;
                const auto found = std::lower_bound(diagonals_.begin(), diagonals_.end(), e);
                if (found == diagonals_.end() || *found != e) continue;
                std::uint8_t& count = counts[std::size_t(found - diagonals_.begin())];
                if (count < 3) ++count;
            }
        }
        for (std::size_t i = 0; i < counts.size(); ++i) {
            if (counts[i] > 2) crowded_.push_back(diagonals_[i]);
        }
    }

    /// Number of triangles at an edge of the mesh in its present state.
    [[nodiscard]] std::ptrdiff_t count(EdgeKey e) {
        if (all_edges_.empty()) {
            all_edges_.reserve(3 * triangles_.size());
            for (const CornerTriple& triangle : triangles_) {
                for (std::size_t k = 0; k < 3; ++k) all_edges_.push_back(edge(triangle, k));
            }
            std::sort(all_edges_.begin(), all_edges_.end());
        }
        const auto [first, last] = std::equal_range(all_edges_.begin(), all_edges_.end(), e);
        const auto change = changes_.find(e);
        return (last - first) + (change == changes_.end() ? 0 : change->second);
    }

    /// The index of the next triangle from `from` on that has the edge; `out` is the triangle
    /// rotated so that the edge is its first.
    [[nodiscard]] std::optional<std::size_t> turned_to(const PolygonTriangles& polygon,
                                                       std::size_t from, EdgeKey diagonal,
                                                       CornerTriple& out) const {
        for (std::size_t i = from; i < polygon.end; ++i) {
            const CornerTriple& t = triangles_[i];
            for (std::size_t k = 0; k < 3; ++k) {
                if (edge(t, k) != diagonal) continue;
                out = {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
                return i;
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] Vec3 area(const CornerTriple& t) const {
        return cross(positions_[t[1]] - positions_[t[0]], positions_[t[2]] - positions_[t[0]]);
    }

    bool turn(const PolygonTriangles& polygon, EdgeKey diagonal) {
        if (count(diagonal) <= 2) return false;  // freed by another polygon
        CornerTriple left{}, right{};
        const auto i = turned_to(polygon, polygon.begin, diagonal, left);
        if (!i) return false;
        const auto j = turned_to(polygon, *i + 1, diagonal, right);
        if (!j || merged_[left[0]] != merged_[right[1]]) return false;
        // The quadrilateral is p, s, q, r in order.
        const std::uint32_t p = left[0], q = left[1], r = left[2], s = right[2];
        if (merged_[r] == merged_[s] || count(key(r, s)) != 0) return false;
        const CornerTriple first{r, p, s}, second{s, q, r};
        const Vec3 whole = area(left) + area(right);
        constexpr double kLeastShare = 1e-9;
        const double least = kLeastShare * dot(whole, whole);
        if (!(dot(area(first), whole) > least) || !(dot(area(second), whole) > least)) return false;
        changes_[diagonal] -= 2;
        changes_[key(r, s)] += 2;
        triangles_[*i] = first;
        triangles_[*j] = second;
        return true;
    }

    std::span<const Vec3> positions_;
    std::span<const PolygonTriangles> polygons_;
    std::vector<CornerTriple>& triangles_;
    std::vector<std::uint32_t> merged_;
    std::vector<EdgeKey> diagonals_, crowded_;  ///< sorted
    std::vector<EdgeKey> edges_;                ///< edges of one polygon
    std::vector<EdgeKey> all_edges_;            ///< sorted; those before any flip
    std::map<EdgeKey, std::ptrdiff_t> changes_;
};

}  // namespace

std::size_t free_diagonals(std::span<const Vec3> positions,
                           std::span<const PolygonTriangles> polygons,
                           std::vector<CornerTriple>& triangles) {
    if (polygons.empty()) return 0;
    return DiagonalTurner(positions, polygons, triangles).run();
}

}  // namespace alhazen
