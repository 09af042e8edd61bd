#include "alhazen/shapes/tessellation/trimmed_triangles.h"

#include <algorithm>
#include <array>

#include "alhazen/math/unit_vector.h"
#include "alhazen/shapes/patches/nurbs/trim_region.h"

namespace alhazen {

namespace {

class TriangleTrimmer {
  public:
    TriangleTrimmer(const NurbsSurface& shape, double tolerance, std::uint64_t max_triangles,
                    TriangleMesh& mesh)
        : shape_(shape), tolerance_(tolerance), max_triangles_(max_triangles), mesh_(mesh) {
        const auto range = [](const std::vector<double>& knots, std::uint32_t degree) {
            return Interval{knots[degree], knots[knots.size() - degree - 1]};
        };
        u_ = range(shape.knots_u, shape.degree_u);
        v_ = range(shape.knots_v, shape.degree_v);
    }

    bool run() {
        std::vector<Triangle> open;
        open.swap(mesh_.triangles);
        while (!open.empty() && mesh_.triangles.size() <= max_triangles_) {
            const Triangle triangle = open.back();
            open.pop_back();
            using Cover = TrimRegion::Cover;
            const Cover cover = cover_of(triangle);
            if (cover == Cover::None) continue;
            if (cover == Cover::All) {
                mesh_.triangles.push_back(triangle);
            } else if (!halve(triangle, open)) {
                cut(triangle);
            }
        }
        return mesh_.triangles.size() <= max_triangles_;
    }

  private:
    using Triangle = std::array<std::uint32_t, 3>;

    [[nodiscard]] TrimRegion::Cover cover_of(const Triangle& triangle) const {
        Vec2 lo = mesh_.uvs[triangle[0]], hi = lo;
        for (const std::uint32_t corner : triangle) {
            const Vec2 p = mesh_.uvs[corner];
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
            hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
        }
        // A loop along the border of the domain keeps the border.
        const auto within = [](double x, const Interval& range) {
            const double margin = 0x1p-40 * (range.hi - range.lo);
            return std::clamp(x, range.lo + margin, range.hi - margin);
        };
        return shape_.region->cover({within(lo.x, u_), within(lo.y, v_)},
                                    {within(hi.x, u_), within(hi.y, v_)});
    }

    /// Divides the longest edge; false if it is short.
    bool halve(const Triangle& triangle, std::vector<Triangle>& open) {
        std::size_t longest = 0;
        double most = -1.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double size =
                length(mesh_.positions[triangle[(k + 1) % 3]] - mesh_.positions[triangle[k]]);
            if (size > most) most = size, longest = k;
        }
        if (most <= tolerance_) return false;
        const std::uint32_t a = triangle[longest], b = triangle[(longest + 1) % 3];
        const std::uint32_t c = triangle[(longest + 2) % 3];
        // The same point from both sides of the edge.
        const std::uint32_t middle = point_between(std::min(a, b), std::max(a, b), 0.5);
        open.push_back({a, middle, c});
        open.push_back({middle, b, c});
        return true;
    }

    std::uint32_t point_between(std::uint32_t a, std::uint32_t b, double share) {
        const auto mean = [&](const auto& values) {
            return (1.0 - share) * values[a] + share * values[b];
        };
        const Vec3 position = mean(mesh_.positions);
        const Vec3 normal = unit_or(mean(mesh_.normals), mesh_.normals[a]);
        const Vec2 uv = mean(mesh_.uvs);
        mesh_.positions.push_back(position);
        mesh_.normals.push_back(normal);
        mesh_.uvs.push_back(uv);
        return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
    }

    [[nodiscard]] bool keeps(const Vec2& uv) const {
        ShapeHit hit;
        hit.u = uv.x;
        hit.v = uv.y;
        return shape_.keeps(hit);
    }

    /// Appends the kept part: the kept corners and the points where the region ends along an edge.
    void cut(const Triangle& triangle) {
        std::vector<std::uint32_t> kept;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
            const bool from = keeps(mesh_.uvs[a]), to = keeps(mesh_.uvs[b]);
            if (from) kept.push_back(a);
            if (from != to) kept.push_back(from ? border(a, b) : border(b, a));
        }
        for (std::size_t k = 2; k < kept.size(); ++k) {
            mesh_.triangles.push_back({kept[0], kept[k - 1], kept[k]});
        }
    }
    /// The border point on the edge from a kept corner to one that is not kept.
    std::uint32_t border(std::uint32_t in, std::uint32_t out) {
        double lo = 0.0, hi = 1.0;
        const Vec2 from = mesh_.uvs[in], to = mesh_.uvs[out];
        for (int round = 0; round < 40; ++round) {
            const double middle = 0.5 * (lo + hi);
            (keeps((1.0 - middle) * from + middle * to) ? lo : hi) = middle;
        }
        return point_between(in, out, lo);
    }

    const NurbsSurface& shape_;
    double tolerance_;
    std::uint64_t max_triangles_;
    TriangleMesh& mesh_;
    Interval u_, v_;
};

/// Removes vertices that no triangle uses.
void drop_unused_vertices(TriangleMesh& mesh) {
    constexpr std::uint32_t kUnused = 0xFFFFFFFFu;
    std::vector<std::uint32_t> number(mesh.positions.size(), kUnused);
    TriangleMesh kept;
    for (auto& triangle : mesh.triangles) {
        for (std::uint32_t& corner : triangle) {
            std::uint32_t& own = number[corner];
            if (own == kUnused) {
                own = static_cast<std::uint32_t>(kept.positions.size());
                kept.positions.push_back(mesh.positions[corner]);
                kept.normals.push_back(mesh.normals[corner]);
                kept.uvs.push_back(mesh.uvs[corner]);
            }
            corner = own;
        }
    }
    mesh.positions = std::move(kept.positions);
    mesh.normals = std::move(kept.normals);
    mesh.uvs = std::move(kept.uvs);
}

}  // namespace

bool trim_triangles(const NurbsSurface& shape, double tolerance, std::uint64_t max_triangles,
                    TriangleMesh& mesh) {
    if (!TriangleTrimmer(shape, tolerance, max_triangles, mesh).run()) return false;
    drop_unused_vertices(mesh);
    return true;
}

}  // namespace alhazen
