#include "alhazen/shapes/patches/bezier_patch.h"

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/patch_checks.h"

namespace alhazen {

BezierNet BezierPatch::net() const {
    return bezier_net(static_cast<int>(degree_u), static_cast<int>(degree_v), points, weights);
}

void BezierPatch::prepare() {
    tree = std::make_shared<PatchTree>(std::vector<BezierPiece>{{.net = net()}});
}

void BezierPatch::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    check_patch_degrees(checks, degree_u, degree_v);
    check_control_points(checks, points, weights);
    const std::size_t expected = (std::size_t{degree_u} + 1) * (std::size_t{degree_v} + 1);
    if (checks.ok() && points.size() != expected) {
        checks.fail("a patch of degree " + std::to_string(degree_u) + " by " +
                    std::to_string(degree_v) + " has " + std::to_string(expected) +
                    " points, not " + std::to_string(points.size()));
    }
}

ShapeSurface BezierPatch::surface(const Ray& ray, const ShapeHit& hit) const {
    return tree->surface(ray, hit);
}

}  // namespace alhazen
