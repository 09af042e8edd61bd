#include "alhazen/formats/mesh/bent_polygon.h"

#include <algorithm>
#include <numeric>

#include "alhazen/base/number_text.h"
#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/geometry/polygon/triangulate.h"
#include "alhazen/geometry/repair/repaired_polygon.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/polygons/flat_vertices.h"

namespace alhazen {

namespace {

/// True if the numbers can be computed with; others are reported by the validation.
bool is_complete(const Polygon& polygon) {
    return polygon.vertices.size() > 3 && std::ranges::all_of(polygon.vertices, [](const Vec3& p) {
               return is_finite(p) && max_component(abs(p)) <= kMaxCoordinate;
           });
}

/// Drops corners of a single loop that are where the one before is.
void drop_repeated(Polygon& polygon) {
    std::vector<Vec3>& v = polygon.vertices;
    if (polygon.loop_ends.size() > 1) return;
    v.erase(std::unique(v.begin(), v.end()), v.end());
    while (v.size() > 1 && v.back() == v.front()) v.pop_back();
    polygon.loop_ends.clear();
}

bool is_simple(const Polygon& polygon, const std::vector<Vec3>& flat) {
    if (polygon.loop_ends.size() > 1) return false;
    const RepairedPolygon repaired = repaired_polygon(
        flat, polygon.loop_ends, {polygon.normal, dot(polygon.normal, polygon.point)});
    return !repaired.crosses && repaired.refused.empty();
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> BentPolygon::triangles() const {
    std::vector<std::array<std::uint32_t, 3>> list;
    std::vector<std::uint32_t> loop(flat.size());
    std::iota(loop.begin(), loop.end(), 0u);
    triangulate(flat, loop, list);
    return list;
}

std::string BentPolygon::warning() const {
    return "its corners are not in a plane, but up to " + shortest(polygon.off_plane) +
           " off: it is ";
}

std::optional<BentPolygon> bent_polygon(const Polygon& given) {
    if (!is_complete(given)) return std::nullopt;
    BentPolygon bent{given, {}};
    drop_repeated(bent.polygon);
    if (!is_complete(bent.polygon)) return std::nullopt;
    bent.polygon.prepare();
    if (is_flat(bent.polygon.vertices, bent.polygon.normal)) return std::nullopt;
    bent.flat = flat_vertices(bent.polygon);
    bent.is_simple = is_simple(bent.polygon, bent.flat);
    return bent;
}

}  // namespace alhazen
