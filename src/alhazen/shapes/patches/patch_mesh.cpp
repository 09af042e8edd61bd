#include "alhazen/shapes/patches/patch_mesh.h"

#include <algorithm>
#include <map>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/patch_checks.h"

namespace alhazen {

namespace {

using CurveKey = std::vector<double>;

/// The control points of a boundary curve, from the end that compares less; empty for a curve that
/// is one point.
CurveKey curve_key(const BezierNet& net, int side) {
    std::array<HomogeneousPoint, kMaxPatchOrder> curve;
    const int count = boundary_curve(net, side, curve);
    CurveKey forward, backward;
    bool point = true;
    for (int k = 0; k < count; ++k) {
        const HomogeneousPoint& a = curve[static_cast<std::size_t>(k)];
        const HomogeneousPoint& b = curve[static_cast<std::size_t>(count - 1 - k)];
        // Adding zero makes -0 and 0 one value.
        for (const double x : {a.x + 0.0, a.y + 0.0, a.z + 0.0, a.w}) forward.push_back(x);
        for (const double x : {b.x + 0.0, b.y + 0.0, b.z + 0.0, b.w}) backward.push_back(x);
        point = point && projected(a) == projected(curve[0]);
    }
    if (point) return {};
    return std::min(forward, backward);
}

}  // namespace

std::size_t PatchMesh::patch_count() const {
    return patches.size() / ((std::size_t{degree_u} + 1) * (std::size_t{degree_v} + 1));
}

BezierNet PatchMesh::net(std::size_t patch) const {
    BezierNet net;
    net.degree_u = static_cast<int>(degree_u);
    net.degree_v = static_cast<int>(degree_v);
    const auto count = static_cast<std::size_t>(net.count());
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t index = patches[patch * count + k];
        net.points[k] = homogeneous(points[index], weights.empty() ? 1.0 : weights[index]);
    }
    return net;
}

void PatchMesh::prepare() {
    std::vector<BezierPiece> pieces;
    pieces.reserve(patch_count());
    std::map<CurveKey, std::uint32_t> uses;
    for (std::size_t patch = 0; patch < patch_count(); ++patch) {
        pieces.push_back({.net = net(patch), .part = static_cast<std::uint32_t>(patch)});
        for (int side = 0; side < 4; ++side) {
            CurveKey key = curve_key(pieces.back().net, side);
            if (!key.empty()) ++uses[std::move(key)];
        }
    }
    is_closed =
        std::all_of(uses.begin(), uses.end(), [](const auto& use) { return use.second % 2 == 0; });
    tree = std::make_shared<PatchTree>(std::move(pieces));
}

void PatchMesh::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    check_patch_degrees(checks, degree_u, degree_v);
    check_control_points(checks, points, weights);
    const std::size_t count = (std::size_t{degree_u} + 1) * (std::size_t{degree_v} + 1);
    if (patches.empty() || patches.size() % count != 0) {
        checks.fail("patches of degree " + std::to_string(degree_u) + " by " +
                    std::to_string(degree_v) + " have " + std::to_string(count) +
                    " indices each; found " + std::to_string(patches.size()) + " in all");
    }
    for (std::size_t k = 0; k < patches.size(); ++k) {
        if (patches[k] >= points.size()) {
            checks.fail("patch " + std::to_string(k / count) + ": there is no point " +
                        std::to_string(patches[k]));
        }
    }
}

ShapeSurface PatchMesh::surface(const Ray& ray, const ShapeHit& hit) const {
    return tree->surface(ray, hit);
}

PatchMeasures measures_of(const PatchMesh& mesh) {
    PatchMeasures sum;
    for (std::size_t patch = 0; patch < mesh.patch_count(); ++patch) {
        const PatchMeasures measures = measures_of(mesh.net(patch));
        sum.area += measures.area;
        sum.flux_volume += measures.flux_volume;
    }
    return sum;
}

}  // namespace alhazen
