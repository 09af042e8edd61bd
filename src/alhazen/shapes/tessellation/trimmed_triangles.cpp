#include "alhazen/shapes/tessellation/trimmed_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include "alhazen/base/interruption.h"
#include "alhazen/geometry/polygon/constrained_triangulation.h"
#include "alhazen/shapes/patches/forms/exact_forms.h"
#include "alhazen/shapes/tessellation/derivative_bounds.h"
#include "alhazen/shapes/tessellation/patch_tessellation.h"
#include "alhazen/shapes/tessellation/trim_division.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kUnused = 0xFFFFFFFFu;

/// A point of a boundary curve: the same bits for both patches that share it.
Vec3 boundary_point(const BezierNet& net, int side, double at) {
    std::array<HomogeneousPoint, kMaxPatchOrder> row;
    const int count = boundary_curve(net, side, row);
    for (int last = count - 1; last > 0; --last) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(last); ++k) {
            row[k] = (1.0 - at) * row[k] + at * row[k + 1];
        }
    }
    return projected(row[0]);
}

Vec3 surface_point(const BezierNet& net, const Vec2& p) {
    if (p.y == 0.0) return boundary_point(net, 0, p.x);
    if (p.y == 1.0) return boundary_point(net, 2, p.x);
    if (p.x == 0.0) return boundary_point(net, 3, p.y);
    if (p.x == 1.0) return boundary_point(net, 1, p.y);
    return point_at(net, p.x, p.y);
}

/// Cuts the triangles of one patch.
class PatchTrimmer {
  public:
    PatchTrimmer(const BezierPiece& piece, PatchTriangles patch, double tolerance)
        : piece_(piece),
          tolerance_(tolerance),
          patch_(std::move(patch)),
          scale_(scale_of(piece.net)),
          triangulation_(triangulation()) {}

    /// Inserts the chords. Returns false if there are more than `max_triangles`.
    bool cut(const TrimDivision::Part& part, std::uint64_t max_triangles) {
        constexpr double kNear = 0x1p-44;
        for (const Vec2& p : part.on_border) triangulation_.insert(in_plane(p));
        for (const auto& [from, to] : part.chords) {
            const auto vertex = [&](const Vec2& p) {
                const Vec2 at = in_plane(p);
                return triangulation_.insert(at, is_on_border(at) ? 0.0 : kNear);
            };
            const std::uint32_t begin = vertex(from);
            triangulation_.connect(begin, vertex(to));
            interruption_point();
            if (triangulation_.triangle_count() > max_triangles) return false;
        }
        const PatchDerivativeBounds all = second_derivative_bounds(piece_.net);
        triangulation_.divide_borders(
            [&](const Vec2& a, const Vec2& b) { return is_long(local(a), local(b), all); });
        triangulation_.improve();
        return triangulation_.triangle_count() <= max_triangles;
    }

    void append_to(const TrimRegion& region, TriangleMesh& mesh) const {
        const std::uint32_t seed = triangulation_.largest();
        Vec2 middle;
        for (const std::uint32_t corner : triangulation_.triangle(seed)) {
            middle = middle + (1.0 / 3.0) * local(triangulation_.points()[corner]);
        }
        const bool keeps_seed = region.contains(in_domain(middle));
        std::vector<std::uint32_t> number(triangulation_.points().size(), kUnused);
        for (auto triangle : triangulation_.triangles(seed, keeps_seed)) {
            for (std::uint32_t& corner : triangle) {
                std::uint32_t& own = number[corner];
                if (own == kUnused) own = append_vertex(corner, mesh);
                corner = own;
            }
            const Vec3& a = mesh.positions[triangle[0]];
            const Vec3& b = mesh.positions[triangle[1]];
            const Vec3& c = mesh.positions[triangle[2]];
            if (a == b || b == c || c == a) continue;
            mesh.triangles.push_back(triangle);
        }
    }

  private:
    /// Factors of u and v, powers of two up to 1, that make the plane look like the patch.
    static Vec2 scale_of(const BezierNet& net) {
        const Vec2 speed = first_derivative_bounds(net);
        if (!(speed.x > 0.0 && speed.y > 0.0)) return {1, 1};
        const double ratio = std::clamp(std::round(std::log2(speed.y / speed.x)), -20.0, 20.0);
        return {std::exp2(std::min(-ratio, 0.0)), std::exp2(std::min(ratio, 0.0))};
    }
    [[nodiscard]] Vec2 local(const Vec2& in_plane) const {
        return {in_plane.x / scale_.x, in_plane.y / scale_.y};
    }
    /// A point of the domain in the plane of the triangulation; exact on borders.
    [[nodiscard]] Vec2 in_plane(const Vec2& p) const {
        const auto at = [](double x, double lo, double hi) {
            return std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
        };
        return {scale_.x * at(p.x, piece_.lo.x, piece_.hi.x),
                scale_.y * at(p.y, piece_.lo.y, piece_.hi.y)};
    }
    [[nodiscard]] Vec2 in_domain(const Vec2& p) const {
        const auto at = [](double x, double lo, double hi) {
            return x == 1.0 ? hi : lo + x * (hi - lo);
        };
        return {at(p.x, piece_.lo.x, piece_.hi.x), at(p.y, piece_.lo.y, piece_.hi.y)};
    }
    [[nodiscard]] bool is_on_border(const Vec2& in_plane) const {
        return in_plane.x == 0.0 || in_plane.x == scale_.x || in_plane.y == 0.0 ||
               in_plane.y == scale_.y;
    }

    /// The triangulation of the patch, with vertices of equal parameters merged.
    ConstrainedTriangulation triangulation() {
        std::vector<PatchVertex>& vertices = patch_.vertices;
        std::vector<std::uint32_t> order(vertices.size());
        std::iota(order.begin(), order.end(), 0u);
        const auto key = [&](std::uint32_t k) {
            return std::tuple(vertices[k].u, vertices[k].v, k);
        };
        std::sort(order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
        std::vector<std::uint32_t> merged(vertices.size());
        std::vector<PatchVertex> kept;
        std::vector<Vec2> points;
        for (const std::uint32_t k : order) {
            const PatchVertex& vertex = vertices[k];
            if (kept.empty() || kept.back().u != vertex.u || kept.back().v != vertex.v) {
                kept.push_back(vertex);
                points.push_back({scale_.x * vertex.u, scale_.y * vertex.v});
            }
            merged[k] = static_cast<std::uint32_t>(kept.size() - 1);
        }
        vertices = std::move(kept);
        for (auto& triangle : patch_.triangles) {
            for (std::uint32_t& corner : triangle) corner = merged[corner];
        }
        return {std::move(points), patch_.triangles};
    }

    /// True if the chord of a straight part of a border is farther than half of the tolerance from
    /// the surface. Borders leave the loops by the other half.
    [[nodiscard]] bool is_long(const Vec2& a, const Vec2& b,
                               const PatchDerivativeBounds& all) const {
        const Vec2 lo{std::min(a.x, b.x), std::min(a.y, b.y)};
        const Vec2 hi{std::max(a.x, b.x), std::max(a.y, b.y)};
        const double u = hi.x - lo.x, v = hi.y - lo.y, limit = 4.0 * tolerance_;
        if (all.uu * u * u + 2.0 * all.uv * u * v + all.vv * v * v <= limit) return false;
        const auto own = second_derivative_bounds(part_of(piece_.net, lo.x, hi.x, lo.y, hi.y));
        return own.uu + 2.0 * own.uv + own.vv > limit;
    }

    std::uint32_t append_vertex(std::uint32_t index, TriangleMesh& mesh) const {
        const Vec2 at = local(triangulation_.points()[index]);
        mesh.positions.push_back(index < patch_.vertices.size() ? patch_.vertices[index].point
                                                                : surface_point(piece_.net, at));
        mesh.normals.push_back(patch_normal(piece_.net, at.x, at.y));
        mesh.uvs.push_back(in_domain(at));
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    }

    const BezierPiece& piece_;
    double tolerance_;
    PatchTriangles patch_;
    Vec2 scale_;
    ConstrainedTriangulation triangulation_;
};

}  // namespace

bool append_trimmed_triangles(const NurbsSurface& shape, double tolerance,
                              std::uint64_t max_triangles, TriangleMesh& mesh) {
    std::vector<BezierPiece> pieces;
    append_pieces(shape, pieces);
    const auto division = divided_trims(shape.trims, pieces, 0.5 * tolerance, max_triangles / 16);
    if (!division) return false;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        interruption_point();
        const BezierPiece& piece = pieces[k];
        const TrimDivision::Part& part = division->parts[k];
        if (part.chords.empty() && part.on_border.empty()) {
            if (!division->region.contains(0.5 * (piece.lo + piece.hi))) continue;
            if (!append_triangles(piece, tolerance, max_triangles, mesh)) return false;
            continue;
        }
        if (mesh.triangles.size() > max_triangles) return false;
        const std::uint64_t most = max_triangles - mesh.triangles.size();
        auto patch = parameter_triangles(piece, tolerance, most);
        if (!patch) return false;
        PatchTrimmer trimmer(piece, std::move(*patch), tolerance);
        if (!trimmer.cut(part, most)) return false;
        trimmer.append_to(division->region, mesh);
    }
    return mesh.triangles.size() <= max_triangles;
}

}  // namespace alhazen
