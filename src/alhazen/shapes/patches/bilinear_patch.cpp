#include "alhazen/shapes/patches/bilinear_patch.h"

#include <algorithm>
#include <utility>

#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/shapes/core/mixed_rounding.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

namespace {

using Sheared = ShearedVertex<double>;

double sheared_cross(const Sheared& a, const Sheared& b) {
    return difference_of_products(a.x, b.y, a.y, b.x);
}
Sheared blended(const Sheared& a, const Sheared& b, double t) {
    const double s = 1.0 - t;
    return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

/// Signed crossings of the half-line {y = 0, x > 0}, displaced by (e, e^2), with the edge from a to
/// b: 1 upward, -1 downward. The reversed edge has the opposite sign.
int edge_crossings(const Sheared& a, const Sheared& b) {
    const bool above = b.y > 0.0;
    if ((a.y > 0.0) == above) return 0;
    const int side = resolved_edge_sign(a, b);
    if (above) return side > 0 ? 1 : 0;
    return side < 0 ? -1 : 0;
}

/// A point of the patch, its distance from the ray in the plane, and the distance of its parameters
/// from those of the root, which may lie outside.
struct BilinearRoot {
    double u = 0, v = 0, off = kInfinity, moved = kInfinity;
};

/// The patch relative to the ray, which is the origin of the plane.
class SeenPatch {
  public:
    SeenPatch(const BilinearPatch& patch, const Ray& ray, const RayShear& shear)
        : a_(seen(patch.p00, ray, shear)),
          b_(seen(patch.p10, ray, shear)),
          c_(seen(patch.p11, ray, shear)),
          d_(seen(patch.p01, ray, shear)) {}

    /// True if all corners are on one side of the ray along one of the axes: no crossing.
    [[nodiscard]] bool beside() const {
        const auto [left, right] = std::minmax({a_.x, b_.x, c_.x, d_.x});
        const auto [low, high] = std::minmax({a_.y, b_.y, c_.y, d_.y});
        return left > 0.0 || right < 0.0 || low > 0.0 || high < 0.0;
    }
    [[nodiscard]] bool winds() const {
        return edge_crossings(a_, b_) + edge_crossings(b_, c_) + edge_crossings(c_, d_) +
                   edge_crossings(d_, a_) !=
               0;
    }
    [[nodiscard]] double reach() const {
        double most = 0.0;
        for (const Sheared* p : {&a_, &b_, &c_, &d_}) {
            most = std::max({most, std::abs(p->x), std::abs(p->y)});
        }
        return most;
    }

    [[nodiscard]] Sheared at(double u, double v) const {
        return blended(blended(a_, b_, u), blended(d_, c_, u), v);
    }
    /// The roots of the quadratic, on the patch or nearest to it. False if there are none; with
    /// `forced`, a negative discriminant counts as 0.
    bool find_roots(bool forced, BilinearRoot* roots) const;
    /// The point of the border that is nearest to the ray.
    [[nodiscard]] BilinearRoot nearest_on_border() const;

  private:
    static Sheared seen(const Vec3& p, const Ray& ray, const RayShear& shear) {
        return sheared<double>(p[shear.kx], p[shear.ky], p[shear.kz], ray.origin[shear.kx],
                               ray.origin[shear.ky], ray.origin[shear.kz], shear.sx, shear.sy);
    }
    [[nodiscard]] BilinearRoot root_on_ruling(double s, double w) const;
    [[nodiscard]] BilinearRoot clamped(double u, double v) const;
    [[nodiscard]] BilinearRoot polished(const BilinearRoot& root, double u, double v) const;

    Sheared a_, b_, c_, d_;  ///< around the border
};

BilinearRoot SeenPatch::clamped(double u, double v) const {
    if (std::isnan(u) || std::isnan(v)) return {};
    const double x = std::clamp(u, 0.0, 1.0), y = std::clamp(v, 0.0, 1.0);
    const Sheared p = at(x, y);
    return {x, y, std::hypot(p.x, p.y), std::max(std::abs(x - u), std::abs(y - v))};
}

BilinearRoot SeenPatch::polished(const BilinearRoot& root, double u, double v) const {
    const Sheared p = at(u, v);
    const Sheared p_u{(1.0 - v) * (b_.x - a_.x) + v * (c_.x - d_.x),
                      (1.0 - v) * (b_.y - a_.y) + v * (c_.y - d_.y), 0.0};
    const Sheared p_v{(1.0 - u) * (d_.x - a_.x) + u * (c_.x - b_.x),
                      (1.0 - u) * (d_.y - a_.y) + u * (c_.y - b_.y), 0.0};
    const double area = sheared_cross(p_u, p_v);
    const BilinearRoot next =
        clamped(u - sheared_cross(p, p_v) / area, v - sheared_cross(p_u, p) / area);
    return next.off < root.off ? next : root;
}

/// The ruling u = s / (s + w), from the edge v = 0 to the edge v = 1, passes through the ray.
BilinearRoot SeenPatch::root_on_ruling(double s, double w) const {
    const double u = s / (s + w);
    if (!std::isfinite(u)) return {};
    const Sheared p = blended(a_, b_, u), q = blended(d_, c_, u);
    const double x = q.x - p.x, y = q.y - p.y;
    const double v = std::abs(x) > std::abs(y) ? -(p.x + p.y * (y / x)) / (x + y * (y / x))
                                               : -(p.y + p.x * (x / y)) / (y + x * (x / y));
    // The ruling is one point, or lies along the ray.
    if (!std::isfinite(v)) return clamped(u, 0.5);
    return polished(clamped(u, v), u, v);
}

bool SeenPatch::find_roots(bool forced, BilinearRoot* roots) const {
    // a x d (1-u)^2 + (a x c + b x d) u (1-u) + b x c u^2 = 0.
    double first = sheared_cross(a_, d_), last = sheared_cross(b_, c_);
    double middle = 0.5 * (sheared_cross(a_, c_) + sheared_cross(b_, d_));
    const double scale = to_unit_size(first, middle, last);
    first *= scale;
    middle *= scale;
    last *= scale;
    double square = difference_of_products(middle, middle, first, last);
    if (!(square >= 0.0)) {
        if (!forced) return false;
        square = 0.0;
    }
    const double q = -(middle + std::copysign(std::sqrt(square), middle));
    roots[0] = root_on_ruling(q, last);
    roots[1] = root_on_ruling(first, q);
    if (q == 0.0) roots[first == 0.0 ? 1 : 0] = roots[first == 0.0 ? 0 : 1];
    return true;
}

BilinearRoot SeenPatch::nearest_on_border() const {
    BilinearRoot nearest;
    const auto look = [&](const Sheared& p, const Sheared& q, auto place) {
        const double x = q.x - p.x, y = q.y - p.y;
        const double s = std::clamp(-(p.x * x + p.y * y) / (x * x + y * y), 0.0, 1.0);
        const Vec2 at = place(std::isnan(s) ? 0.5 : s);
        const BilinearRoot root = clamped(at.x, at.y);
        if (root.off < nearest.off) nearest = root;
    };
    look(a_, b_, [](double s) { return Vec2{s, 0.0}; });
    look(b_, c_, [](double s) { return Vec2{1.0, s}; });
    look(d_, c_, [](double s) { return Vec2{s, 1.0}; });
    look(a_, d_, [](double s) { return Vec2{0.0, s}; });
    return nearest;
}

/// Largest distance of a root from the ray, relative to `reach`. The rounding is about 2^-50.
constexpr double kOnPatch = 0x1p-44;
/// Largest distance of a root's parameters from the unit square; near a double root they are
/// accurate to 2^-26.
constexpr double kOnSquare = 0x1p-20;

double largest_coordinate(const BilinearPatch& patch) {
    double most = 0.0;
    for (const Vec3& p : {patch.p00, patch.p10, patch.p01, patch.p11}) {
        most = std::max(most, max_component(abs(p)));
    }
    return most;
}

/// Bound of the rounding by which a crossing may leave the patch.
double crossing_reach(const BilinearPatch& patch) {
    return 1e-14 * largest_coordinate(patch);
}

}  // namespace

void BilinearPatch::prepare() {
    const Vec3 from[3] = {p10 - p00, p01 - p00, p11 - p00};
    double reach = max_component(abs(p00)), size = 0.0, area = 0.0;
    for (int k = 0; k < 3; ++k) {
        reach = std::max(reach, max_component(abs(p00 + from[k])));
        size = std::max(size, max_component(abs(from[k])));
        const Vec3 normal = accurate_cross(from[k], from[(k + 1) % 3]);
        area = std::max(area, max_component(abs(normal)));
    }
    is_line = !(area > 0x1p-51 * reach * size);
}

void BilinearPatch::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks(kName, where, diagnostics).fields(*this);
}

Box3 BilinearPatch::box() const {
    Box3 box;
    for (const Vec3& p : {p00, p10, p01, p11}) box.include(p);
    const double reach = crossing_reach(*this);
    return {box.lo - Vec3{reach, reach, reach}, box.hi + Vec3{reach, reach, reach}};
}

Interval BilinearPatch::extent(const Vec3& axis) const {
    Interval range{kInfinity, -kInfinity};
    for (const Vec3& p : {p00, p10, p01, p11}) {
        const double x = dot(axis, p);
        range = {std::min(range.lo, x), std::max(range.hi, x)};
    }
    const Vec3 size = abs(axis);
    const double reach = crossing_reach(*this) * (size.x + size.y + size.z);
    return {range.lo - reach, range.hi + reach};
}

int BilinearPatch::intersect(const Ray& ray, ShapeHit* hits) const {
    if (is_line) return 0;
    const RayShear shear(ray.direction);
    const SeenPatch seen(*this, ray, shear);
    if (seen.beside()) return 0;
    const bool winds = seen.winds();
    BilinearRoot roots[2];
    if (!seen.find_roots(winds, roots)) return 0;
    if (roots[0].off > roots[1].off) std::swap(roots[0], roots[1]);
    const double most_off = kOnPatch * seen.reach();
    const auto hit_at = [&](const BilinearRoot& root) {
        return ShapeHit{shear.sz * seen.at(root.u, root.v).z, root.u, root.v, 0};
    };
    if (winds) {
        // A patch seen edge on may have no accurate root.
        if (!(roots[0].off <= most_off)) {
            const BilinearRoot other = seen.nearest_on_border();
            if (!(roots[0].off <= other.off)) roots[0] = other;
        }
        return report_crossing(ray, hit_at(roots[0]), hits);
    }
    if (!(roots[1].off <= most_off)) return 0;
    if (!(std::max(roots[0].moved, roots[1].moved) <= kOnSquare)) return 0;
    ShapeHit near = hit_at(roots[0]), far = hit_at(roots[1]);
    if (far.t < near.t || (far.t == near.t && far.u < near.u)) std::swap(near, far);
    const int count = report_crossing(ray, near, hits);
    return count + report_crossing(ray, far, hits + count);
}

ShapeSurface BilinearPatch::surface(const Ray&, const ShapeHit& hit) const {
    const double u = std::clamp(hit.u, 0.0, 1.0), v = std::clamp(hit.v, 0.0, 1.0);
    ShapeSurface surface;
    surface.point = (1.0 - v) * ((1.0 - u) * p00 + u * p10) + v * ((1.0 - u) * p01 + u * p11);
    surface.uv = {u, v};
    surface.dpdu = (1.0 - v) * (p10 - p00) + v * (p11 - p01);
    surface.dpdv = (1.0 - u) * (p01 - p00) + u * (p11 - p10);
    const Vec3 normal = accurate_cross(surface.dpdu, surface.dpdv);
    const double size = length(normal);
    if (size > 1e-10 * (dot(surface.dpdu, surface.dpdu) + dot(surface.dpdv, surface.dpdv))) {
        surface.normal = normal / size;
    } else {
        const Vec3 points[4] = {p00, p01, p10, p11};
        surface.normal = patch_normal(bezier_net(1, 1, points), u, v);
    }
    surface.shading_normal = surface.normal;
    // The rounding of each coordinate: convex combinations in two steps with three roundings each,
    // and 1 - u.
    for (int k = 0; k < 3; ++k) {
        const double most = std::max(std::max(std::abs(p00[k]), std::abs(p10[k])),
                                     std::max(std::abs(p01[k]), std::abs(p11[k])));
        surface.error[k] = gamma_bound(10) * most;
    }
    surface.error += patch_test_rounding(largest_coordinate(*this));
    return surface;
}

}  // namespace alhazen
