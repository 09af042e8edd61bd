#include "alhazen/renderers/core/coincident_surfaces.h"

#include <algorithm>
#include <cmath>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

namespace {

constexpr double kLeastReachCosine = 1e-3;
/// Barycentric coordinates of triangles below this are at an edge.
constexpr double kAtEdge = 1e-6;

bool is_same_primitive(const Hit& a, const Hit& b) {
    if (a.primitive != b.primitive || a.path.size() != b.path.size()) return false;
    for (std::size_t level = 0; level < a.path.size(); ++level) {
        if (a.path[level] != b.path[level]) return false;
    }
    return true;
}

}  // namespace

double CoincidentSurfaces::reach(const ShapeSurface& surface, const Vec3& direction) {
    const double cosine = std::max(std::abs(dot(direction, surface.normal)), kLeastReachCosine);
    return LeavingRays::margin(surface) / cosine;
}

Ray CoincidentSurfaces::around(const ShapeSurface& surface, const Vec3& direction) {
    const double away = reach(surface, direction);
    return {surface.point - away * direction, direction, 0.0,
            std::max(2.0 * away, LeavingRays::kBeyondZero)};
}

void CoincidentSurfaces::find(const Surface& surface, const Hit& hit, const Ray& from,
                              const RayQuery& query) {
    clear();
    ray_ = around(surface, from.direction);
    const double away = reach(surface, from.direction);
    ray_.t_min = std::max(0.0, away - std::max(0.0, hit.t - from.t_min));
    ray_.t_max = std::min(ray_.t_max, away + (from.t_max - hit.t));
    scene_.aggregate->all_hits(ray_, hits_, query);
    sides_.clear();
    if (hits_.size() > 1 && is_at_border(hit)) {
        sides_.push_back(
            {parts_of(*scene_.aggregate, hit), dot(from.direction, surface.normal) < 0.0});
    }
    std::erase_if(hits_, [&](const Hit& other) {
        return is_same_primitive(hit, other) || is_known(other, query.time);
    });
}

bool CoincidentSurfaces::is_at_border(const Hit& hit) const {
    const PrimitiveTable* table = &scene_.aggregate->primitives();
    for (std::size_t level = hit.path.size(); level-- > 0;) {
        table = &table->instances[table->index(hit.path[level])].aggregate->primitives();
    }
    // Other shapes than triangles are the only ones of their part, or pieces of one surface.
    if (table->kind(hit.primitive) != kTriangleKind) return true;
    return std::min({hit.u, hit.v, 1.0 - hit.u - hit.v}) < kAtEdge;
}

bool CoincidentSurfaces::is_known(const Hit& hit, float time) {
    if (!is_at_border(hit)) return false;
    set_surface(*scene_.aggregate, ray_, hit, CoordinateNeed::none(), other_, time);
    const Side side{{other_.part, other_.instance}, dot(ray_.direction, other_.normal) < 0.0};
    if (std::find(sides_.begin(), sides_.end(), side) != sides_.end()) return true;
    sides_.push_back(side);
    return false;
}

}  // namespace alhazen
