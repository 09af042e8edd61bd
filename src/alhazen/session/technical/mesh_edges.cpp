#include "alhazen/session/technical/mesh_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

constexpr double kCrease = 0.906;       ///< cosine of 25 degrees
constexpr double kSolidCrease = 0.819;  ///< cosine of 35 degrees

/// A side of a triangle; its ends are numbers of positions.
struct Side {
    std::uint32_t lo, hi;
    std::uint32_t triangle;
    std::uint32_t at_lo, at_hi;  ///< vertex indices of the ends

    bool operator<(const Side& o) const {
        return std::tie(lo, hi, triangle) < std::tie(o.lo, o.hi, o.triangle);
    }
};

/// Numbers positions. Positions of corners that differ by rounding (less than `same`) get one
/// number.
class PlaceNumbers {
  public:
    explicit PlaceNumbers(double same) : same_(same) {}

    std::uint32_t number_of(const Vec3& p) {
        // A cell has the side 4 `same`: neighbours lie in the cells of the eight corners around
        // `p`.
        for (int k = 0; k < 8; ++k) {
            const Vec3 corner{p.x + ((k & 1) != 0 ? same_ : -same_),
                              p.y + ((k & 2) != 0 ? same_ : -same_),
                              p.z + ((k & 4) != 0 ? same_ : -same_)};
            const auto found = cells_.find(cell(corner));
            if (found == cells_.end()) continue;
            for (const auto& [at, number] : found->second) {
                if (max_component(abs(at - p)) <= same_) return number;
            }
        }
        cells_[cell(p)].push_back({p, count_});
        return count_++;
    }

  private:
    /// Whole numbers, which may be larger than integers.
    using Cell = std::array<double, 3>;
    [[nodiscard]] Cell cell(const Vec3& p) const {
        const auto along = [&](double x) { return std::floor(x / (4.0 * same_)); };
        return {along(p.x), along(p.y), along(p.z)};
    }

    double same_;
    std::uint32_t count_ = 0;
    std::map<Cell, std::vector<std::pair<Vec3, std::uint32_t>>> cells_;
};

class MeshEdgeFinder {
  public:
    MeshEdgeFinder(const TriangleMesh& mesh, const BeamApex& eye, MeshSource source)
        : mesh_(mesh), eye_(eye), source_(source) {}

    std::vector<MeshEdge> find() {
        const std::vector<Side> sides = sorted_sides();
        for (std::size_t first = 0; first < sides.size();) {
            std::size_t end = first + 1;
            while (end < sides.size() && sides[end].lo == sides[first].lo &&
                   sides[end].hi == sides[first].hi) {
                ++end;
            }
            add_edge({sides.data() + first, end - first});
            first = end;
        }
        if (!mesh_.normals.empty() && source_ != MeshSource::Itself) {
            for (const auto& t : mesh_.triangles) add_contour(t);
        }
        return std::move(edges_);
    }

  private:
    [[nodiscard]] std::vector<Side> sorted_sides() const {
        // Files with six digits differ by 1e-6.
        constexpr double kSame = 2e-6;
        PlaceNumbers numbers(kSame * std::max(max_component(mesh_.box().size()), 1e-300));
        std::vector<std::uint32_t> place;
        for (const Vec3& p : mesh_.positions) place.push_back(numbers.number_of(p));
        std::vector<Side> sides;
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3];
                if (place[a] == place[b]) continue;
                if (place[a] < place[b]) {
                    sides.push_back({place[a], place[b], t, a, b});
                } else {
                    sides.push_back({place[b], place[a], t, b, a});
                }
            }
        }
        std::sort(sides.begin(), sides.end());
        return sides;
    }

    [[nodiscard]] Vec3 face(std::uint32_t t) const {
        const auto& c = mesh_.triangles[t];
        const Vec3& a = mesh_.positions[c[0]];
        return unit_or(cross(mesh_.positions[c[1]] - a, mesh_.positions[c[2]] - a), {});
    }
    [[nodiscard]] double facing(const Vec3& normal, const Vec3& point) const {
        return dot(normal, eye_.at - eye_.weight * point);
    }

    void add_edge(std::span<const Side> sides) {
        const Vec3 &a = mesh_.positions[sides[0].at_lo], &b = mesh_.positions[sides[0].at_hi];
        const Vec3 n = face(sides[0].triangle);
        if (sides.size() == 1) {
            edges_.push_back({MeshEdge::Kind::Border, a, b, n, n});
            return;
        }
        const Vec3 m = face(sides[1].triangle);
        const bool solid = source_ == MeshSource::Solid, itself = source_ == MeshSource::Itself;
        bool is_edge = sides.size() > 2 || (solid && dot(n, m) < kSolidCrease) ||
                       (itself && (facing(n, a) > 0.0) != (facing(m, a) > 0.0));
        if (mesh_.normals.empty()) {
            is_edge =
                is_edge || dot(n, m) < kCrease || (facing(n, a) > 0.0) != (facing(m, a) > 0.0);
        } else {
            const auto differ = [&](std::uint32_t u, std::uint32_t v) {
                const Vec3 &p = mesh_.normals[u], &q = mesh_.normals[v];
                return dot(p, q) < kCrease * length(p) * length(q);
            };
            is_edge = is_edge || (differ(sides[0].at_lo, sides[1].at_lo) &&
                                  differ(sides[0].at_hi, sides[1].at_hi));
        }
        if (is_edge) edges_.push_back({MeshEdge::Kind::Edge, a, b, n, m});
    }

    void add_contour(const std::array<std::uint32_t, 3>& t) {
        std::array<double, 3> g{};
        for (std::size_t k = 0; k < 3; ++k) {
            g[k] = facing(mesh_.normals[t[k]], mesh_.positions[t[k]]);
        }
        std::array<Vec3, 2> ends, normals;
        std::size_t found = 0;
        for (std::size_t k = 0; k < 3 && found < 2; ++k) {
            std::size_t i = k, j = (k + 1) % 3;
            if ((g[i] > 0.0) == (g[j] > 0.0)) continue;
            if (t[j] < t[i]) std::swap(i, j);
            const double share = g[i] / (g[i] - g[j]);
            const Vec3 &p = mesh_.positions[t[i]], &q = mesh_.positions[t[j]];
            ends[found] = p + share * (q - p);
            normals[found++] =
                mesh_.normals[t[i]] + share * (mesh_.normals[t[j]] - mesh_.normals[t[i]]);
        }
        if (found < 2) return;
        edges_.push_back({MeshEdge::Kind::Contour, ends[0], ends[1], normals[0], normals[1]});
    }

    const TriangleMesh& mesh_;
    BeamApex eye_;
    MeshSource source_;
    std::vector<MeshEdge> edges_;
};

}  // namespace

std::vector<MeshEdge> mesh_edges(const TriangleMesh& mesh, const BeamApex& eye, MeshSource source) {
    return MeshEdgeFinder(mesh, eye, source).find();
}

}  // namespace alhazen
