#include "disagreements.h"

#include <algorithm>
#include <cmath>

namespace alhazen::bench {

namespace {

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Extended;
constexpr double kZero = 0x1p-88;  ///< a sum below this part of its terms may be a rounding error
#else
using Extended = long double;
constexpr double kZero = 0x1p-44;
#endif

/// Rounding of the tests of spheres and cylinders in double, relative to the terms.
constexpr double kGrazing = 0x1p-44;
/// Tolerances of t, in noise units.
constexpr double kOurTolerance = 0x1p-36;
constexpr double kFloatTolerance = 0x1p-20;

struct Vec {
    Extended x, y, z;
};
Vec extended(const Vec3& v) {
    return {Extended(v.x), Extended(v.y), Extended(v.z)};
}
Vec operator-(const Vec& a, const Vec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec cross(const Vec& a, const Vec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Extended dot(const Vec& a, const Vec& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Extended magnitude(Extended x) {
    return x < 0 ? -x : x;
}
double as_double(Extended x) {
    return static_cast<double>(x);
}

/// Square root by two Newton steps from the root in double; each squares the error.
Extended root(Extended x) {
    if (!(x > 0)) return 0;
    Extended r = std::sqrt(as_double(x));
    for (int i = 0; i < 2 && r > 0; ++i) r = Extended(0.5) * (r + x / r);
    return r;
}

/// A possible answer to a ray.
struct Crossing {
    Extended t;
    bool sure;  ///< false: touched
};

/// The sign of x: -1, 0 or 1; also 0 if x is a rounding error relative to `scale`.
int sign_of(Extended x, Extended scale, double noise = kZero) {
    if (magnitude(x) <= Extended(noise) * scale) return 0;
    return x > 0 ? 1 : -1;
}

/// Largest absolute component.
Extended reach(const Vec& a) {
    const Extended x = magnitude(a.x), y = magnitude(a.y), z = magnitude(a.z);
    return x > y ? (x > z ? x : z) : (y > z ? y : z);
}

/// Conservative test in double: false only if the ray passes far outside an edge.
bool may_hit(const Ray& ray, const std::array<Vec3, 3>& corner) {
    const Vec3 a = corner[0] - ray.origin, b = corner[1] - ray.origin, c = corner[2] - ray.origin;
    const Vec3& d = ray.direction;
    const double margin = 1e-10 * max_component(abs(d)) *
                          std::max({length_squared(a), length_squared(b), length_squared(c)});
    const double u = alhazen::dot(d, alhazen::cross(b, c));
    const double v = alhazen::dot(d, alhazen::cross(c, a));
    const double w = alhazen::dot(d, alhazen::cross(a, b));
    return !(std::min({u, v, w}) < -margin && std::max({u, v, w}) > margin);
}

void cross_triangle(const Ray& ray, const std::array<Vec3, 3>& corner,
                    std::vector<Crossing>& crossings) {
    const Vec o = extended(ray.origin), d = extended(ray.direction);
    const Vec a = extended(corner[0]) - o, b = extended(corner[1]) - o, c = extended(corner[2]) - o;
    const Extended scale =
        reach(d) * std::max({reach(a) * reach(b), reach(b) * reach(c), reach(c) * reach(a)});
    const Extended u = dot(d, cross(b, c)), v = dot(d, cross(c, a)), w = dot(d, cross(a, b));
    const int su = sign_of(u, scale), sv = sign_of(v, scale), sw = sign_of(w, scale);
    if ((su < 0 || sv < 0 || sw < 0) && (su > 0 || sv > 0 || sw > 0)) return;
    const Vec n = cross(b - a, c - a);
    const Extended along = dot(n, d);
    // A triangle seen exactly edge-on is never hit.
    if (sign_of(along, reach(n) * reach(d)) == 0) return;
    crossings.push_back({dot(n, a) / along, su != 0 && sv != 0 && sw != 0});
}

/// Adds both ends of an interval of t; `noise` is their error in double.
void add_interval(Extended lo, Extended hi, Extended noise, bool touched,
                  std::vector<Crossing>& crossings) {
    if (hi < lo - noise) return;
    const bool sure = !touched && hi > lo + noise;
    crossings.push_back({lo, sure});
    crossings.push_back({hi, sure});
}

void cross_sphere(const Ray& ray, const Sphere& sphere, std::vector<Crossing>& crossings) {
    const Vec o = extended(ray.origin) - extended(sphere.center), d = extended(ray.direction);
    const Extended r = sphere.radius, a = dot(d, d), b = dot(o, d);
    const Vec moment = cross(o, d);
    const Extended discriminant = a * r * r - dot(moment, moment);
    const int sign = sign_of(discriminant, a * (r * r + dot(o, o)), kGrazing);
    if (sign < 0) return;
    const Extended s = root(discriminant);
    add_interval((-b - s) / a, (-b + s) / a, 0, sign == 0, crossings);
}

void cross_cylinder(const Ray& ray, const Cylinder& cylinder, std::vector<Crossing>& crossings) {
    const Vec base = extended(cylinder.base), axis = extended(cylinder.top) - base;
    const Vec o = extended(ray.origin) - base, d = extended(ray.direction);
    const Extended length2 = dot(axis, axis), r2 = Extended(cylinder.radius) * cylinder.radius;
    // All terms are multiplied by length2, which avoids normalizing the axis.
    const Extended oz = dot(o, axis), dz = dot(d, axis);
    const Extended a = dot(d, d) * length2 - dz * dz;
    const Extended b = dot(o, d) * length2 - oz * dz;
    const Extended moment = dot(axis, cross(o, d));
    const Extended discriminant = a * r2 - moment * moment;
    const int sign = sign_of(discriminant, length2 * dot(d, d) * (r2 + dot(o, o)), kGrazing);
    // A line parallel to the side is outside.
    if (sign < 0 || sign_of(a, length2 * dot(d, d)) == 0) return;
    // The roots of a t^2 + 2 b t + c; its discriminant is length2 times that above.
    const Extended s = root(discriminant * length2);
    Extended lo = (-b - s) / a, hi = (-b + s) / a;
    if (dz != 0) {
        const Extended bottom = -oz / dz, top = (length2 - oz) / dz;
        lo = std::max(lo, std::min(bottom, top));
        hi = std::min(hi, std::max(bottom, top));
    } else if (!(oz > 0 && oz < length2)) {
        return;
    }
    const Extended noise = Extended(kGrazing) * root((r2 + dot(o, o)) / dot(d, d));
    add_interval(lo, hi, noise, sign == 0, crossings);
}

std::vector<Crossing> all_crossings(const KernelScene& scene, const Ray& ray) {
    std::vector<Crossing> crossings;
    for (const auto& [a, b, c] : scene.mesh.triangles) {
        const std::array<Vec3, 3> corner{scene.mesh.positions[a], scene.mesh.positions[b],
                                         scene.mesh.positions[c]};
        if (may_hit(ray, corner)) cross_triangle(ray, corner, crossings);
    }
    for (const Sphere& s : scene.spheres) cross_sphere(ray, s, crossings);
    for (const Cylinder& c : scene.cylinders) cross_cylinder(ray, c, crossings);
    return crossings;
}

/// True if an answer is one of the right ones, with t known to `tolerance`.
bool is_right(const std::vector<Crossing>& crossings, const Ray& ray, bool any_hit, double answer,
              double tolerance) {
    const auto may_count = [&](const Crossing& c) {
        const double t = as_double(c.t);
        return t >= ray.t_min - tolerance && t <= ray.t_max + tolerance;
    };
    const auto must_count = [&](const Crossing& c) {
        const double t = as_double(c.t);
        return c.sure && t >= ray.t_min + tolerance && t <= ray.t_max - tolerance;
    };
    const bool hit = std::isfinite(answer);
    if (!hit) return std::none_of(crossings.begin(), crossings.end(), must_count);
    if (any_hit) return std::any_of(crossings.begin(), crossings.end(), may_count);
    const auto nearer_and_sure = [&](const Crossing& c) {
        return must_count(c) && as_double(c.t) < answer - tolerance;
    };
    const auto is_it = [&](const Crossing& c) {
        return may_count(c) && std::abs(as_double(c.t) - answer) <= tolerance;
    };
    return std::none_of(crossings.begin(), crossings.end(), nearer_and_sure) &&
           std::any_of(crossings.begin(), crossings.end(), is_it);
}

}  // namespace

Judge::Judge(const KernelScene& scene) : scene_(scene) {
    const Box3 box = scene.box();
    reach_ = std::max(length(box.lo), length(box.hi));
}

double Judge::noise_unit(const Ray& ray, double t) const {
    const double way = std::isfinite(t) ? std::abs(t) : 0;
    return way + (length(ray.origin) + reach_) / length(ray.direction);
}

bool Judge::disagree(const Ray& ray, bool any_hit, double ours, double peer) const {
    if (std::isfinite(ours) != std::isfinite(peer)) return true;
    if (any_hit || !std::isfinite(ours)) return false;
    return std::abs(ours - peer) > float_noise(ray, ours);
}

double Judge::float_noise(const Ray& ray, double t) const {
    return kFloatTolerance * noise_unit(ray, t);
}

Verdict Judge::decide(const Ray& ray, bool any_hit, double ours, double peer) const {
    const std::vector<Crossing> crossings = all_crossings(scene_, ray);
    Verdict verdict;
    verdict.true_t = HUGE_VAL;
    for (const Crossing& c : crossings) {
        const double t = as_double(c.t);
        if (c.sure && ray.covers(t)) verdict.true_t = std::min(verdict.true_t, t);
    }
    const double unit = noise_unit(ray, std::isfinite(ours) ? ours : peer);
    verdict.ours_wrong = !is_right(crossings, ray, any_hit, ours, kOurTolerance * unit);
    verdict.peer_wrong = !is_right(crossings, ray, any_hit, peer, kFloatTolerance * unit);
    return verdict;
}

}  // namespace alhazen::bench
