#include "alhazen/shapes/patches/steiner_patch.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/core/mixed_rounding.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/patch_checks.h"
#include "alhazen/shapes/patches/patch_tree.h"

namespace alhazen {

namespace {

constexpr int kSteinerPoints = 6;

/// Converts a hit of the tree to the parameters of the triangle.
ShapeHit on_triangle(const ShapeHit& hit) {
    return {hit.t, hit.u * (1.0 - hit.v), hit.v, 0};
}

}  // namespace

SteinerValue steiner_value(const std::array<HomogeneousPoint, 6>& p, double u, double v) {
    const double r = 1.0 - u - v;
    const HomogeneousPoint a = r * p[0] + u * p[1] + v * p[3];
    const HomogeneousPoint b = r * p[1] + u * p[2] + v * p[4];
    const HomogeneousPoint c = r * p[3] + u * p[4] + v * p[5];
    return {r * a + u * b + v * c, 2.0 * (b - a), 2.0 * (c - a)};
}

std::array<HomogeneousPoint, 6> SteinerPatch::control_points() const {
    std::array<HomogeneousPoint, 6> result;
    for (std::size_t k = 0; k < result.size(); ++k) {
        result[k] = homogeneous(points[k], weights.empty() ? 1.0 : weights[k]);
    }
    return result;
}

BezierNet SteinerPatch::net() const {
    const std::array<HomogeneousPoint, 6> p = control_points();
    // Rows of the triangle raised to degree 2 in s.
    BezierNet net;
    net.degree_u = net.degree_v = 2;
    for (int i = 0; i < 3; ++i) net.at(i, 0) = p[static_cast<std::size_t>(i)];
    net.at(0, 1) = p[3];
    net.at(1, 1) = 0.5 * (p[3] + p[4]);
    net.at(2, 1) = p[4];
    for (int i = 0; i < 3; ++i) net.at(i, 2) = p[5];
    return net;
}

void SteinerPatch::prepare() {
    tree = std::make_shared<PatchTree>(std::vector<BezierPiece>{{.net = net()}});
    bounds = tree->box();
}

void SteinerPatch::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    check_control_points(checks, points, weights);
    if (points.size() != kSteinerPoints) {
        checks.fail("a Steiner patch has 6 points, not " + std::to_string(points.size()));
    }
}

Interval SteinerPatch::extent(const Vec3& axis) const {
    return tree->extent(axis);
}

int SteinerPatch::intersect(const Ray& ray, ShapeHit* hits) const {
    ShapeHits found;
    tree->intersect(ray, found);
    const int count = static_cast<int>(std::min<std::size_t>(found.size(), kMaxHits));
    for (int k = 0; k < count; ++k) hits[k] = on_triangle(found[static_cast<std::size_t>(k)]);
    return count;
}

bool first_hit(const SteinerPatch& shape, const Ray& ray, ShapeHit& hit) {
    ShapeHit found;
    if (!shape.tree->first_hit(ray, found)) return false;
    hit = on_triangle(found);
    return true;
}

ShapeSurface SteinerPatch::surface(const Ray&, const ShapeHit& hit) const {
    const double v = std::clamp(hit.v, 0.0, 1.0), u = std::clamp(hit.u, 0.0, 1.0 - v);
    const std::array<HomogeneousPoint, 6> control = control_points();
    const SteinerValue value = steiner_value(control, u, v);
    ShapeSurface surface;
    surface.point = projected(value.s);
    surface.uv = {u, v};
    const auto derivative = [&](const HomogeneousPoint& d) {
        return (Vec3{d.x, d.y, d.z} - d.w * surface.point) / value.s.w;
    };
    surface.dpdu = derivative(value.s_u);
    surface.dpdv = derivative(value.s_v);
    const Vec3 normal = accurate_cross(surface.dpdu, surface.dpdv);
    const double size = length(normal);
    if (size > 1e-10 * (dot(surface.dpdu, surface.dpdu) + dot(surface.dpdv, surface.dpdv))) {
        surface.normal = normal / size;
    } else {
        surface.normal = patch_normal(tree->pieces().net(0), v < 1.0 ? u / (1.0 - v) : 0.5, v);
    }
    surface.shading_normal = surface.normal;
    // Two steps of three terms, for the numerator and the weight, and one division; the mean of the
    // points' magnitudes is at most the largest. A different 1 - u - v gives another point of the
    // surface.
    Vec3 most;
    for (const HomogeneousPoint& p : control) {
        const Vec3 x = abs(projected(p));
        most = {std::max(most.x, x.x), std::max(most.y, x.y), std::max(most.z, x.z)};
    }
    surface.error = (2.0 * gamma_bound(12)) * most + patch_test_rounding(max_component(most));
    return surface;
}

}  // namespace alhazen
