#include "alhazen/shapes/patches/patch_tree.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

namespace {

/// A patch in the two planes through the ray: a root of both coordinates is a crossing.
struct PlaneNet {
    int degree_u = 0, degree_v = 0;
    std::array<Vec2, kMaxPatchOrder * kMaxPatchOrder> at;

    [[nodiscard]] int count() const { return (degree_u + 1) * (degree_v + 1); }
};

bool straddles(const PlaneNet& net) {
    Vec2 lo{1, 1}, hi{-1, -1};
    lo = hi = net.at[0];
    for (int k = 1; k < net.count(); ++k) {
        const Vec2& p = net.at[static_cast<std::size_t>(k)];
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    return lo.x <= 0 && hi.x >= 0 && lo.y <= 0 && hi.y >= 0;
}

void halve(const PlaneNet& net, bool along_u, PlaneNet& low, PlaneNet& high) {
    low.degree_u = high.degree_u = net.degree_u;
    low.degree_v = high.degree_v = net.degree_v;
    const int degree = along_u ? net.degree_u : net.degree_v;
    const int rows = along_u ? net.degree_v : net.degree_u;
    const int row_stride = along_u ? 1 : net.degree_v + 1;
    const int stride = along_u ? net.degree_v + 1 : 1;
    for (int r = 0; r <= rows; ++r) {
        Vec2 work[kMaxPatchOrder];
        const auto index = [&](int k) {
            return static_cast<std::size_t>(r * row_stride + k * stride);
        };
        for (int k = 0; k <= degree; ++k) work[k] = net.at[index(k)];
        for (int level = 0; level <= degree; ++level) {
            low.at[index(level)] = work[0];
            high.at[index(degree - level)] = work[degree - level];
            for (int k = 0; k < degree - level; ++k) work[k] = 0.5 * (work[k] + work[k + 1]);
        }
    }
}

struct Search {
    const Ray& ray;
    const BezierPiece& piece;
    Vec3 n1, n2;
    double along;
    ShapeHits& hits;
    std::vector<Vec2> found{};

    void polish(double u, double v, double width) {
        for (int step = 0; step < 8; ++step) {
            const PatchPoint p = derivatives_at(piece.net, u, v);
            const Vec3 d = p.point - ray.origin;
            const double f = dot(n1, d), g = dot(n2, d);
            const double fu = dot(n1, p.du), fv = dot(n1, p.dv);
            const double gu = dot(n2, p.du), gv = dot(n2, p.dv);
            const double det = fu * gv - fv * gu;
            if (det == 0.0) break;
            u = std::clamp(u - (f * gv - g * fv) / det, 0.0, 1.0);
            v = std::clamp(v - (g * fu - f * gu) / det, 0.0, 1.0);
        }
        for (const Vec2& old : found) {
            if (std::abs(old.x - u) + std::abs(old.y - v) < 4 * width) return;
        }
        found.push_back({u, v});
        const double t = dot(point_at(piece.net, u, v) - ray.origin, ray.direction) / along;
        ShapeHit hit{t, u, v, piece.part};
        hit.u = piece.lo.x + u * (piece.hi.x - piece.lo.x);
        hit.v = piece.lo.y + v * (piece.hi.y - piece.lo.y);
        hits.grow(report_crossing(ray, hit, hits.room(1)));
    }

    void divide(const PlaneNet& net, double u0, double u1, double v0, double v1) {
        if (!straddles(net)) return;
        if (u1 - u0 < 0x1p-10 && v1 - v0 < 0x1p-10) {
            polish(0.5 * (u0 + u1), 0.5 * (v0 + v1), u1 - u0);
            return;
        }
        PlaneNet low, high;
        const bool along_u = u1 - u0 >= v1 - v0;
        halve(net, along_u, low, high);
        const double um = 0.5 * (u0 + u1), vm = 0.5 * (v0 + v1);
        divide(low, u0, along_u ? um : u1, v0, along_u ? v1 : vm);
        divide(high, along_u ? um : u0, u1, along_u ? v0 : vm, v1);
    }
};

}  // namespace

PatchTree::PatchTree(std::vector<BezierPiece> pieces) : pieces_(std::move(pieces)) {
    for (const BezierPiece& piece : pieces_) box_.include(control_box(piece.net));
    box_ = padded(box_, 1e-13);
}

Interval PatchTree::extent(const Vec3& axis) const {
    Interval range{kInfinity, -kInfinity};
    for (const BezierPiece& piece : pieces_) {
        for (int k = 0; k < piece.net.count(); ++k) {
            const double x = dot(axis, projected(piece.net.points[static_cast<std::size_t>(k)]));
            range = {std::min(range.lo, x), std::max(range.hi, x)};
        }
    }
    const double reach =
        1e-13 * dot(abs(axis), Vec3{std::max(std::abs(box_.lo.x), std::abs(box_.hi.x)),
                                    std::max(std::abs(box_.lo.y), std::abs(box_.hi.y)),
                                    std::max(std::abs(box_.lo.z), std::abs(box_.hi.z))});
    return {range.lo - reach, range.hi + reach};
}

void PatchTree::intersect(const Ray& ray, ShapeHits& hits) const {
    const std::size_t first = hits.size();
    const Vec3 d = ray.direction / length(ray.direction);
    const Vec3 n1 = perpendicular(d);
    const Vec3 n2 = cross(d, n1);
    for (const BezierPiece& piece : pieces_) {
        PlaneNet net;
        net.degree_u = piece.net.degree_u;
        net.degree_v = piece.net.degree_v;
        for (int k = 0; k < piece.net.count(); ++k) {
            const HomogeneousPoint& p = piece.net.points[static_cast<std::size_t>(k)];
            const Vec3 offset = Vec3{p.x, p.y, p.z} - p.w * ray.origin;
            net.at[static_cast<std::size_t>(k)] = {dot(n1, offset), dot(n2, offset)};
        }
        Search{ray, piece, n1, n2, dot(ray.direction, ray.direction), hits}.divide(net, 0, 1, 0, 1);
    }
    std::sort(hits.begin() + first, hits.end(),
              [](const ShapeHit& a, const ShapeHit& b) { return a.t < b.t; });
}

ShapeSurface PatchTree::surface(const Ray&, const ShapeHit& hit) const {
    const BezierPiece& piece = *std::find_if(
        pieces_.begin(), pieces_.end(), [&](const BezierPiece& p) { return p.part == hit.part; });
    const double u = (hit.u - piece.lo.x) / (piece.hi.x - piece.lo.x);
    const double v = (hit.v - piece.lo.y) / (piece.hi.y - piece.lo.y);
    const PatchPoint p = derivatives_at(piece.net, u, v);
    ShapeSurface surface;
    surface.point = p.point;
    surface.normal = surface.shading_normal = patch_normal(piece.net, u, v);
    surface.uv = {hit.u, hit.v};
    surface.dpdu = p.du;
    surface.dpdv = p.dv;
    surface.error = 1e-14 * Vec3{1, 1, 1} * (length(p.point) + 1.0);
    return surface;
}

std::size_t PatchTree::bytes() const {
    return sizeof *this + pieces_.capacity() * sizeof(BezierPiece);
}

}  // namespace alhazen
