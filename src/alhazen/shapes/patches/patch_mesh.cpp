#include "alhazen/shapes/patches/patch_mesh.h"

#include <algorithm>
#include <map>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/patch_checks.h"
#include "alhazen/shapes/patches/patch_value.h"

namespace alhazen {

namespace {

using CurveKey = std::vector<double>;

/// The control points of a boundary curve, from the end that compares less; empty for a curve that
/// is one point. `turned`: whether that is against the patch's border, counterclockwise in (u, v).
CurveKey curve_key(const BezierNet& net, int side, bool& turned) {
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
    turned = (side >= 2) != (backward < forward);
    return std::min(forward, backward);
}

struct CurveUse {
    std::uint32_t patch;
    bool turned;
};
using CurveUses = std::map<CurveKey, std::vector<CurveUse>>;

/// A third of the integral of (P - center) . n over a patch, roughly.
double rough_flux(const BezierNet& net, const Vec3& center) {
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const PatchValue at = patch_value(net, (i + 0.5) / 4, (j + 0.5) / 4);
            sum += dot(at.point - center, cross(at.du, at.dv));
        }
    }
    return sum;
}

/// The patches of a closed mesh whose normal points inward: neighbours agree across the curve that
/// they share, and all together enclose a positive volume.
std::vector<bool> inward_patches(std::span<const BezierPiece> pieces, const CurveUses& uses,
                                 const Vec3& center) {
    struct Neighbour {
        std::uint32_t patch;
        bool against;
    };
    std::vector<std::vector<Neighbour>> neighbours(pieces.size());
    for (const auto& [curve, users] : uses) {
        if (users.size() != 2) continue;
        const bool against = users[0].turned == users[1].turned;
        neighbours[users[0].patch].push_back({users[1].patch, against});
        neighbours[users[1].patch].push_back({users[0].patch, against});
    }
    std::vector<bool> inward(pieces.size()), seen(pieces.size());
    double flux = 0.0;
    std::vector<std::uint32_t> next;
    for (std::uint32_t first = 0; first < pieces.size(); ++first) {
        if (!seen[first]) next.push_back(first);
        seen[first] = true;
        while (!next.empty()) {
            const std::uint32_t patch = next.back();
            next.pop_back();
            flux += (inward[patch] ? -1.0 : 1.0) * rough_flux(pieces[patch].net, center);
            for (const Neighbour& other : neighbours[patch]) {
                if (seen[other.patch]) continue;
                seen[other.patch] = true;
                inward[other.patch] = inward[patch] != other.against;
                next.push_back(other.patch);
            }
        }
    }
    if (flux < 0.0) inward.flip();
    return inward;
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
    CurveUses uses;
    for (std::size_t patch = 0; patch < patch_count(); ++patch) {
        pieces.push_back({.net = net(patch), .part = static_cast<std::uint32_t>(patch)});
        for (int side = 0; side < 4; ++side) {
            bool turned = false;
            CurveKey key = curve_key(pieces.back().net, side, turned);
            if (key.empty()) continue;
            uses[std::move(key)].push_back({static_cast<std::uint32_t>(patch), turned});
        }
    }
    is_closed = std::all_of(uses.begin(), uses.end(),
                            [](const auto& use) { return use.second.size() % 2 == 0; });
    inward.clear();
    tree = std::make_shared<PatchTree>(std::move(pieces));
    if (is_closed) inward = inward_patches(tree->pieces(), uses, tree->box().center());
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
    ShapeSurface surface = tree->surface(ray, hit);
    if (is_closed && inward[hit.part]) {
        surface.normal = surface.shading_normal = -surface.normal;
    }
    return surface;
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
