#include "alhazen/shapes/tessellation/patch_tessellation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/shapes/tessellation/curve_division.h"
#include "alhazen/shapes/tessellation/derivative_bounds.h"

namespace alhazen {

namespace {

constexpr int kMaxLineHalvings = 16;
/// Smallest factor on the tolerance; a smaller tolerance places lines closer.
constexpr double kTightest = 1.0 / 4096.0;

/// Appends lines that divide [0, 1] so that `fits(low, high)` holds between neighbours.
template <class Fits>
void divide_range(double low, double high, int depth, const Fits& fits,
                  std::vector<double>& lines) {
    if (depth < kMaxLineHalvings && (depth == 0 || !fits(low, high))) {
        const double middle = 0.5 * (low + high);
        divide_range(low, middle, depth + 1, fits, lines);
        divide_range(middle, high, depth + 1, fits, lines);
        return;
    }
    lines.push_back(high);
}

double largest_gap(const std::vector<CurveDivisionPoint>& border) {
    double gap = 0;
    for (std::size_t k = 0; k + 1 < border.size(); ++k) {
        gap = std::max(gap, border[k + 1].parameter - border[k].parameter);
    }
    return gap;
}

/// What the triangles at an edge that is one point look like in the parameter plane.
enum class AtPoint {
    Mean,  ///< the point has the parameter of the middle of each triangle
    Tiles  ///< they tile it
};

class PatchMesher {
  public:
    PatchMesher(const BezierPiece& piece, double tolerance, AtPoint at_point)
        : piece_(piece), net_(piece.net), tolerance_(tolerance), at_point_(at_point) {
        for (int side = 0; side < 4; ++side) {
            std::array<HomogeneousPoint, kMaxPatchOrder> curve;
            const auto count = static_cast<std::size_t>(boundary_curve(net_, side, curve));
            borders_[static_cast<std::size_t>(side)] =
                divided_curve(std::span(curve).first(count), tolerance / 16.0);
        }
    }

    /// Returns false if more than `max_triangles` would be made.
    bool make(std::uint64_t max_triangles) {
        for (double share = 1.0; share >= kTightest; share *= 0.5) {
            place_lines(share);
            const std::uint64_t triangles = 2 * u_lines_.size() * v_lines_.size();
            if (triangles > max_triangles) return false;
            triangulate();
            if (strips_fit_) return true;
        }
        return true;
    }

    void append_to(TriangleMesh& mesh) const {
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        for (const PatchVertex& vertex : vertices_) {
            mesh.positions.push_back(vertex.point);
            mesh.normals.push_back(patch_normal(net_, vertex.u, vertex.v));
            mesh.uvs.push_back({piece_.lo.x + vertex.u * (piece_.hi.x - piece_.lo.x),
                                piece_.lo.y + vertex.v * (piece_.hi.y - piece_.lo.y)});
        }
        for (const auto& t : triangles_) {
            const Vec3& a = vertices_[t[0]].point;
            const Vec3& b = vertices_[t[1]].point;
            const Vec3& c = vertices_[t[2]].point;
            if (a == b || b == c || c == a) continue;
            mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
        }
    }

    [[nodiscard]] PatchTriangles take() { return {std::move(vertices_), std::move(triangles_)}; }

  private:
    /// Places the inner lines for a share of the tolerance, and a line near each border, so that
    /// triangles with a long side on the border are flat enough.
    void place_lines(double share) {
        const PatchDerivativeBounds all = second_derivative_bounds(net_);
        const double aspect =
            all.uu > 0.0 && all.vv > 0.0 ? std::clamp(std::sqrt(all.uu / all.vv), 0.125, 8.0) : 1.0;
        const double limit = 4.0 * share * tolerance_;  // half of the tolerance, times 8
        u_lines_ = {0.0};
        divide_range(
            0.0, 1.0, 0,
            [&](double low, double high) {
                const auto m = second_derivative_bounds(part_of(net_, low, high, 0, 1));
                return m.uu + aspect * m.uv * (high - low) <= limit;
            },
            u_lines_);
        v_lines_ = {0.0};
        divide_range(
            0.0, 1.0, 0,
            [&](double low, double high) {
                const auto m = second_derivative_bounds(part_of(net_, 0, 1, low, high));
                return m.vv + m.uv * (high - low) / aspect <= limit;
            },
            v_lines_);
        const double twist = std::max(all.uv, std::numeric_limits<double>::min());
        const auto near_border = [&](std::vector<double>& lines, std::size_t low_side,
                                     std::size_t high_side) {
            const auto distance = [&](std::size_t side) {
                constexpr double kLeast = 0x1p-40;  // distinct from the border
                const double gap = largest_gap(borders_[side]);
                return std::max(share * tolerance_ / (twist * gap), kLeast);
            };
            const double low = distance(low_side), high = distance(high_side);
            if (low < lines[1]) lines.insert(lines.begin() + 1, low);
            if (high < 1.0 - lines[lines.size() - 2]) lines.insert(lines.end() - 1, 1.0 - high);
        };
        near_border(v_lines_, 0, 2);
        near_border(u_lines_, 3, 1);
    }

    std::uint32_t add(double u, double v, const Vec3& point) {
        vertices_.push_back({u, v, point});
        return static_cast<std::uint32_t>(vertices_.size() - 1);
    }

    void triangulate() {
        vertices_.clear();
        triangles_.clear();
        strips_fit_ = true;
        const std::size_t columns = u_lines_.size() - 2, rows = v_lines_.size() - 2;
        for (std::size_t i = 1; i <= columns; ++i) {
            for (std::size_t j = 1; j <= rows; ++j) {
                add(u_lines_[i], v_lines_[j], point_at(net_, u_lines_[i], v_lines_[j]));
            }
        }
        const auto inner = [&](std::size_t i, std::size_t j) {
            return static_cast<std::uint32_t>(i * rows + j);
        };
        for (std::size_t i = 0; i + 1 < columns; ++i) {
            for (std::size_t j = 0; j + 1 < rows; ++j) {
                triangles_.push_back({inner(i, j), inner(i + 1, j), inner(i + 1, j + 1)});
                triangles_.push_back({inner(i, j), inner(i + 1, j + 1), inner(i, j + 1)});
            }
        }
        for (int side = 0; side < 4; ++side) {
            std::vector<std::uint32_t> row;
            if (side % 2 == 0) {
                for (std::size_t i = 0; i < columns; ++i) {
                    row.push_back(inner(i, side == 0 ? 0 : rows - 1));
                }
            } else {
                for (std::size_t j = 0; j < rows; ++j) {
                    row.push_back(inner(side == 3 ? 0 : columns - 1, j));
                }
            }
            stitch(side, row);
        }
    }

    /// Triangles between a border and the nearest inner line.
    void stitch(int side, const std::vector<std::uint32_t>& row) {
        const bool along_u = side % 2 == 0;
        const double fixed = side == 1 || side == 2 ? 1.0 : 0.0;
        std::vector<std::uint32_t> border;
        const auto add_border = [&](double at, const Vec3& point) {
            border.push_back(add(along_u ? at : fixed, along_u ? fixed : at, point));
        };
        const auto& points = borders_[static_cast<std::size_t>(side)];
        if (is_point(side) && at_point_ == AtPoint::Tiles) {
            for (const double at : along_u ? u_lines_ : v_lines_) add_border(at, points[0].point);
        } else {
            for (const CurveDivisionPoint& p : points) add_border(p.parameter, p.point);
        }
        const auto parameter = [&](std::uint32_t vertex) {
            return along_u ? vertices_[vertex].u : vertices_[vertex].v;
        };
        // For sides 0 and 1 the patch is to the left of ascending parameters.
        const bool patch_left = side < 2;
        const PatchDerivativeBounds bounds = strip_bounds(side, row.front());
        if (is_point(side) && at_point_ == AtPoint::Mean) return fan(side, row, bounds);
        std::size_t b = 0, r = 0;
        while (b + 1 < border.size() || r + 1 < row.size()) {
            const bool border_next =
                r + 1 == row.size() ||
                (b + 1 < border.size() && parameter(border[b]) + parameter(border[b + 1]) <=
                                              parameter(row[r]) + parameter(row[r + 1]));
            const std::uint32_t base = border_next ? border[b + 1] : row[r + 1];
            std::array<std::uint32_t, 3> triangle{border[b], base, row[r]};
            if (!patch_left) std::swap(triangle[1], triangle[2]);
            triangles_.push_back(triangle);
            strips_fit_ = strips_fit_ && fits(triangle, bounds);
            (border_next ? b : r) += 1;
        }
    }

    [[nodiscard]] bool is_point(int side) const {
        const auto& border = borders_[static_cast<std::size_t>(side)];
        return std::all_of(border.begin(), border.end(),
                           [&](const CurveDivisionPoint& p) { return p.point == border[0].point; });
    }

    /// Triangles between a border that is one point and the nearest inner line. The point may have
    /// any parameter: that of the other two corners is used.
    void fan(int side, const std::vector<std::uint32_t>& row, const PatchDerivativeBounds& bounds) {
        const bool along_u = side % 2 == 0;
        const double fixed = side == 1 || side == 2 ? 1.0 : 0.0;
        const Vec3 point = borders_[static_cast<std::size_t>(side)][0].point;
        for (std::size_t r = 0; r + 1 < row.size(); ++r) {
            const PatchVertex a = vertices_[row[r]], b = vertices_[row[r + 1]];
            const std::uint32_t pole = along_u ? add(0.5 * (a.u + b.u), fixed, point)
                                               : add(fixed, 0.5 * (a.v + b.v), point);
            std::array<std::uint32_t, 3> triangle{pole, row[r + 1], row[r]};
            if (side >= 2) std::swap(triangle[1], triangle[2]);
            triangles_.push_back(triangle);
            strips_fit_ = strips_fit_ && fits(triangle, bounds);
        }
    }

    /// Bounds over the strip between a border and the inner line of `vertex`.
    [[nodiscard]] PatchDerivativeBounds strip_bounds(int side, std::uint32_t vertex) const {
        const double u = vertices_[vertex].u, v = vertices_[vertex].v;
        const BezierNet strip = side == 0   ? part_of(net_, 0, 1, 0, v)
                                : side == 1 ? part_of(net_, u, 1, 0, 1)
                                : side == 2 ? part_of(net_, 0, 1, v, 1)
                                            : part_of(net_, 0, u, 0, 1);
        PatchDerivativeBounds m = second_derivative_bounds(strip);
        const double width = side == 0 ? v : side == 1 ? 1.0 - u : side == 2 ? 1.0 - v : u;
        if (side % 2 == 0) {
            m.uv /= width;
            m.vv /= width * width;
        } else {
            m.uv /= width;
            m.uu /= width * width;
        }
        // The differences of a narrow strip are mostly rounding.
        const PatchDerivativeBounds all = second_derivative_bounds(net_);
        return {std::min(m.uu, all.uu), std::min(m.uv, all.uv), std::min(m.vv, all.vv)};
    }

    [[nodiscard]] bool fits(const std::array<std::uint32_t, 3>& triangle,
                            const PatchDerivativeBounds& m) const {
        Vec2 lo{1, 1}, hi{0, 0};
        for (const std::uint32_t corner : triangle) {
            const PatchVertex& vertex = vertices_[corner];
            lo = {std::min(lo.x, vertex.u), std::min(lo.y, vertex.v)};
            hi = {std::max(hi.x, vertex.u), std::max(hi.y, vertex.v)};
        }
        const Vec2 size = hi - lo;
        const double error =
            m.uu * size.x * size.x + 2.0 * m.uv * size.x * size.y + m.vv * size.y * size.y;
        if (error <= 8.0 * tolerance_) return true;
        // The strip's bounds hold at its point of largest curvature; those of the triangle's own
        // rectangle may be smaller.
        const auto own = second_derivative_bounds(part_of(net_, lo.x, hi.x, lo.y, hi.y));
        return own.uu + 2.0 * own.uv + own.vv <= 8.0 * tolerance_;
    }

    const BezierPiece& piece_;
    const BezierNet& net_;
    double tolerance_;
    AtPoint at_point_;
    std::array<std::vector<CurveDivisionPoint>, 4> borders_;  ///< [side]
    std::vector<double> u_lines_, v_lines_;                   ///< from 0 to 1
    std::vector<PatchVertex> vertices_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    bool strips_fit_ = false;
};

}  // namespace

bool append_triangles(const BezierPiece& piece, double tolerance, std::uint64_t max_triangles,
                      TriangleMesh& mesh) {
    PatchMesher mesher(piece, tolerance, AtPoint::Mean);
    if (mesh.triangles.size() > max_triangles ||
        !mesher.make(max_triangles - mesh.triangles.size())) {
        return false;
    }
    mesher.append_to(mesh);
    return true;
}

std::optional<PatchTriangles> parameter_triangles(const BezierPiece& piece, double tolerance,
                                                  std::uint64_t max_triangles) {
    PatchMesher mesher(piece, tolerance, AtPoint::Tiles);
    if (!mesher.make(max_triangles)) return std::nullopt;
    return mesher.take();
}

}  // namespace alhazen
