#include "alhazen/session/scene_info/patch_figures.h"

#include <algorithm>
#include <map>

namespace alhazen {

namespace {

constexpr std::size_t kShownCurves = 8;

/// The control points of a boundary curve from the end that compares less; empty for a curve that
/// is one point.
std::vector<double> boundary_key(const BezierNet& net, int side) {
    std::array<HomogeneousPoint, kMaxPatchOrder> curve;
    const auto count = static_cast<std::size_t>(boundary_curve(net, side, curve));
    std::vector<double> forward, backward;
    bool one_point = true;
    for (std::size_t k = 0; k < count; ++k) {
        for (const bool back : {false, true}) {
            const HomogeneousPoint& p = curve[back ? count - 1 - k : k];
            // Adding zero makes -0 and 0 one value.
            for (const double c : {p.x + 0.0, p.y + 0.0, p.z + 0.0, p.w}) {
                (back ? backward : forward).push_back(c);
            }
        }
        one_point = one_point && projected(curve[k]) == projected(curve[0]);
    }
    if (one_point) return {};
    return std::min(forward, backward);
}

Vec3 end_of_key(const std::vector<double>& key, bool last) {
    const std::size_t at = last ? key.size() - 4 : 0;
    return projected({key[at], key[at + 1], key[at + 2], key[at + 3]});
}

/// The number of patches of a shape.
std::size_t net_count(const AnyShape& shape) {
    if (const auto* mesh = std::get_if<PatchMesh>(&shape)) return mesh->patch_count();
    return std::holds_alternative<BezierPatch>(shape) ||
                   std::holds_alternative<BilinearPatch>(shape)
               ? 1
               : 0;
}

BezierNet net_of(const AnyShape& shape, std::size_t patch) {
    if (const auto* mesh = std::get_if<PatchMesh>(&shape)) return mesh->net(patch);
    if (const auto* flat = std::get_if<BilinearPatch>(&shape)) {
        const std::array points{flat->p00, flat->p01, flat->p10, flat->p11};
        return bezier_net(1, 1, points);
    }
    return std::get<BezierPatch>(shape).net();
}

}  // namespace

namespace {

using CurveUses = std::map<std::vector<double>, std::size_t>;

void note_open_curves(const CurveUses& uses, PatchFigures& figures) {
    std::size_t open = 0;
    for (const auto& [key, count] : uses) {
        if (count % 2 == 0) continue;
        ++open;
        if (figures.first_open.size() < kShownCurves) {
            figures.first_open.push_back({end_of_key(key, false), end_of_key(key, true)});
        }
    }
    figures.open_curves = open;
    figures.closed = open == 0;
}

std::size_t own_points(const AnyShape& shape) {
    if (const auto* mesh = std::get_if<PatchMesh>(&shape)) return mesh->points.size();
    const auto* patch = std::get_if<BezierPatch>(&shape);
    return patch != nullptr ? patch->points.size() : 4;
}

}  // namespace

std::optional<PatchFigures> patch_figures(const AnyShape& shape, bool measure) {
    PatchFigures figures;
    figures.patches = net_count(shape);
    if (figures.patches == 0) return std::nullopt;
    figures.control_points = own_points(shape);
    if (!measure) return figures;
    CurveUses uses;
    PatchMeasures sum;
    for (std::size_t patch = 0; patch < figures.patches; ++patch) {
        const BezierNet net = net_of(shape, patch);
        for (int side = 0; side < 4; ++side) {
            std::vector<double> key = boundary_key(net, side);
            if (!key.empty()) ++uses[std::move(key)];
        }
        const PatchMeasures own = measures_of(net);
        sum.area += own.area;
        sum.flux_volume += own.flux_volume;
    }
    figures.area = sum.area;
    figures.flux_volume = sum.flux_volume;
    note_open_curves(uses, figures);
    return figures;
}

}  // namespace alhazen
