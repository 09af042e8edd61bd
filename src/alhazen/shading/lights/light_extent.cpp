#include "alhazen/shading/lights/light_extent.h"

#include <algorithm>
#include <cmath>

#include "alhazen/base/overloaded.h"
#include "alhazen/math/constants.h"
#include "alhazen/shading/lights/extent_triangles.h"

namespace alhazen {

namespace {

/// Ranges of directions: squares of the faces of a cube.
constexpr int kSquares = 8;  ///< along an edge
constexpr std::size_t kNormalRanges = 6 * kSquares * kSquares;
std::size_t range_of_normal(const Vec3& n) {
    const Vec3 size = abs(n);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto square = [&](int k) {
        const double across = n[(axis + k) % 3] / std::abs(n[axis]);
        return std::clamp(static_cast<int>(0.5 * kSquares * (across + 1.0)), 0, kSquares - 1);
    };
    const int face = 2 * axis + (n[axis] < 0.0);
    return static_cast<std::size_t>((face * kSquares + square(1)) * kSquares + square(2));
}

/// The vector with these components in a frame around the unit `axis`.
Vec3 around(const Vec3& axis, double along, double x, double y) {
    const Vec3 a = perpendicular(axis), b = cross(axis, a);
    return along * axis + x * a + y * b;
}

}  // namespace

Vec2 on_unit_disc(const Vec2& u) {
    const double x = 2.0 * u.x - 1.0, y = 2.0 * u.y - 1.0;
    if (x == 0.0 && y == 0.0) return {};
    const bool wide = std::abs(x) > std::abs(y);
    const double r = wide ? x : y;
    const double angle = wide ? kPi / 4 * (y / x) : kPi / 2 - kPi / 4 * (x / y);
    return {r * std::cos(angle), r * std::sin(angle)};
}

Vec3 direction_in_cone(const Vec3& axis, double versine, const Vec2& u) {
    const double z = 1.0 - u.x * versine;
    const double across = std::sqrt(std::max(0.0, 1.0 - z * z)), angle = 2.0 * kPi * u.y;
    const Vec3 a = perpendicular(axis), b = cross(axis, a);
    return normalize(z * axis + (across * std::cos(angle)) * a + (across * std::sin(angle)) * b);
}

LightSurface::LightSurface(const LightExtent& extent, bool two_sided)
    : extent_(extent), two_sided_(two_sided) {
    std::visit(Overloaded{[&](const RectangleExtent& r) {
                              const Vec3 n = cross(r.edge_u, r.edge_v);
                              area_ = length(n);
                              normal_ = n / area_;
                              center_ = r.corner + 0.5 * (r.edge_u + r.edge_v);
                          },
                          [&](const DiscExtent& d) {
                              area_ = kPi * (d.radius * d.radius - d.inner_radius * d.inner_radius);
                              normal_ = normalize(d.normal);
                              center_ = d.center;
                          },
                          [&](const SphereExtent& s) {
                              area_ = 4.0 * kPi * s.radius * s.radius;
                              center_ = s.center;
                          },
                          [&](const TubeExtent& t) {
                              area_ = 2.0 * kPi * t.radius * length(t.top - t.base);
                              normal_ = normalize(t.top - t.base);
                              center_ = 0.5 * (t.base + t.top);
                          },
                          [&](const PolygonExtent& p) {
                              set_triangles(triangles_of(p));
                              if (corners_.empty()) return;
                              normal_ = normalize(
                                  cross(corners_[1] - corners_[0], corners_[2] - corners_[0]));
                          },
                          [&](const MeshExtent& m) {
                              set_triangles(m);
                              set_normal_areas();
                          }},
               extent_);
}

void LightSurface::set_triangles(const MeshExtent& mesh) {
    Vec3 sum;
    for (const auto& [i, j, k] : mesh.triangles) {
        const Vec3 &a = mesh.points[i], &b = mesh.points[j], &c = mesh.points[k];
        const double area = 0.5 * length(cross(b - a, c - a));
        if (!(area > 0.0)) continue;
        corners_.insert(corners_.end(), {a, b, c});
        area_ += area;
        areas_.push_back(area_);
        sum += (area / 3.0) * (a + b + c);
    }
    if (area_ > 0.0) center_ = sum / area_;
}

void LightSurface::set_normal_areas() {
    const std::size_t triangles = corners_.size() / 3;
    const bool gathers = triangles > kMostTriangles;
    if (gathers) normal_areas_.resize(kNormalRanges);
    for (std::size_t k = 0; k < triangles; ++k) {
        const Vec3* const c = &corners_[3 * k];
        const Vec3 area = 0.5 * cross(c[1] - c[0], c[2] - c[0]);
        if (gathers) {
            normal_areas_[range_of_normal(area)] += area;
        } else {
            normal_areas_.push_back(area);
        }
    }
    std::erase(normal_areas_, Vec3{});
}

double LightSurface::projected_area(const Vec3& direction) const {
    if (std::holds_alternative<SphereExtent>(extent_)) return area_ / 4.0;
    if (std::holds_alternative<MeshExtent>(extent_)) {
        double sum = 0.0;
        for (const Vec3& area : normal_areas_) {
            const double seen = -dot(direction, area);
            sum += two_sided_ ? std::abs(seen) : std::max(0.0, seen);
        }
        return sum;
    }
    const double cosine = -dot(direction, normal_);
    if (std::holds_alternative<TubeExtent>(extent_)) {
        const double outside = area_ / kPi * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        return (two_sided_ ? 2.0 : 1.0) * outside;
    }
    return area_ * (two_sided_ ? std::abs(cosine) : std::max(0.0, cosine));
}

ExtentSample LightSurface::sample(const Vec3& from, const Vec2& u) const {
    return std::visit(
        Overloaded{[&](const RectangleExtent& r) {
                       return seen(from, {r.corner + u.x * r.edge_u + u.y * r.edge_v, normal_,
                                          1.0 / area_});
                   },
                   [&](const DiscExtent& d) {
                       Vec2 p = on_unit_disc(u);
                       if (d.inner_radius > 0.0) {
                           const double q = d.inner_radius / d.radius;
                           const double r = std::sqrt(q * q + u.x * (1.0 - q * q));
                           p = {r * std::cos(2.0 * kPi * u.y), r * std::sin(2.0 * kPi * u.y)};
                       }
                       return seen(from,
                                   {d.center + around(normal_, 0, d.radius * p.x, d.radius * p.y),
                                    normal_, 1.0 / area_});
                   },
                   [&](const SphereExtent& s) { return on_sphere(s, from, u); },
                   [&](const TubeExtent& t) { return seen(from, on_tube(t, from, u)); },
                   [&](const auto&) { return seen(from, on_triangles(u)); }},
        extent_);
}

ExtentSample LightSurface::seen(const Vec3& from, const Place& place) const {
    const Vec3 offset = place.point - from;
    const double squared = length_squared(offset), distance = std::sqrt(squared);
    if (!(distance > 0.0)) return {};
    const Vec3 to_light = offset / distance;
    double cosine = -dot(to_light, place.normal);
    if (two_sided_) cosine = std::abs(cosine);
    if (!(cosine > 0.0)) return {};
    return {to_light, place.normal, distance, place.density * squared / cosine};
}

ExtentSample LightSurface::on_sphere(const SphereExtent& s, const Vec3& from, const Vec2& u) const {
    const Vec3 axis = s.center - from;
    const double d2 = length_squared(axis), r2 = s.radius * s.radius;
    const Vec2 p = on_unit_disc(u);
    const double share = p.x * p.x + p.y * p.y;
    if (!(d2 > r2)) {
        // From inside: uniform by area, z = 1 - 2 share.
        const double z = 1.0 - 2.0 * share, scale = 2.0 * std::sqrt(std::max(0.0, 1.0 - share));
        const Vec3 n{scale * p.x, scale * p.y, z};
        return seen(from, {s.center + s.radius * n, n, 1.0 / area_});
    }
    const double d = std::sqrt(d2), sine2 = r2 / d2;
    // 1 - cosine of the cone's half angle, without cancellation.
    const double cap = sine2 / (1.0 + std::sqrt(1.0 - sine2));
    const double height = share * cap, cosine = 1.0 - height;
    const double across = std::sqrt(cap * (2.0 - height));
    const Vec3 direction = normalize(around(axis / d, cosine, across * p.x, across * p.y));
    const double sine_here2 = height * (2.0 - height);
    const double distance = d * cosine - std::sqrt(std::max(0.0, r2 - d2 * sine_here2));
    const Vec3 normal = normalize(from + distance * direction - s.center);
    return {direction, normal, distance, 1.0 / (2.0 * kPi * cap)};
}

LightSurface::Place LightSurface::on_tube(const TubeExtent& t, const Vec3& from,
                                          const Vec2& u) const {
    const Vec3 offset = from - t.base;
    const Vec3 out = offset - dot(offset, normal_) * normal_;
    const double away = length(out);
    double half = kPi;  // half of the sampled angle
    if (!two_sided_ && away > t.radius) half = std::acos(t.radius / away);
    const Vec3 x = away > 0.0 ? out / away : perpendicular(normal_), y = cross(normal_, x);
    const double angle = half * (2.0 * u.x - 1.0);
    const Vec3 n = std::cos(angle) * x + std::sin(angle) * y;
    const Vec3 point = t.base + u.y * (t.top - t.base) + t.radius * n;
    return {point, n, kPi / (half * area_)};
}

LightSurface::Place LightSurface::on_triangles(const Vec2& u) const {
    const double wanted = u.x * area_;
    const auto found = std::upper_bound(areas_.begin(), areas_.end(), wanted);
    const std::size_t i =
        std::min<std::size_t>(std::size_t(found - areas_.begin()), areas_.size() - 1);
    const double before = i == 0 ? 0.0 : areas_[i - 1];
    const double x = std::clamp((wanted - before) / (areas_[i] - before), 0.0, 1.0);
    const double root = std::sqrt(x);
    const Vec3 &a = corners_[3 * i], &b = corners_[3 * i + 1], &c = corners_[3 * i + 2];
    const Vec3 point = (1.0 - root) * a + (root * (1.0 - u.y)) * b + (root * u.y) * c;
    return {point, normalize(cross(b - a, c - a)), 1.0 / area_};
}

const char* fault_of(const LightExtent& extent) {
    const auto radius = [](double r) { return r > 0.0 && std::isfinite(r); };
    const auto all_finite = [](const std::vector<Vec3>& points) {
        return std::all_of(points.begin(), points.end(),
                           [](const Vec3& p) { return is_finite(p); });
    };
    const bool ok = std::visit(
        Overloaded{[](const RectangleExtent& r) {
                       return is_finite(r.corner) && length(cross(r.edge_u, r.edge_v)) > 0.0 &&
                              is_finite(r.edge_u) && is_finite(r.edge_v);
                   },
                   [&](const DiscExtent& d) {
                       return is_finite(d.center) && is_finite(d.normal) && d.normal != Vec3{} &&
                              radius(d.radius) && d.inner_radius >= 0.0 &&
                              d.inner_radius < d.radius;
                   },
                   [&](const SphereExtent& s) { return is_finite(s.center) && radius(s.radius); },
                   [&](const TubeExtent& t) {
                       return is_finite(t.base) && is_finite(t.top) && t.base != t.top &&
                              radius(t.radius);
                   },
                   [&](const PolygonExtent& p) {
                       return p.vertices.size() >= 3 && all_finite(p.vertices) &&
                              LightSurface(p, false).area() > 0.0;
                   },
                   [&](const MeshExtent& m) {
                       const auto in_range = [&](const std::array<std::uint32_t, 3>& t) {
                           return std::max({t[0], t[1], t[2]}) < m.points.size();
                       };
                       return all_finite(m.points) &&
                              std::all_of(m.triangles.begin(), m.triangles.end(), in_range) &&
                              LightSurface(m, false).area() > 0.0;
                   }},
        extent);
    return ok ? nullptr : "the light's surface must be finite and have an area above 0";
}

}  // namespace alhazen
