#pragma once
/// Whole scenes as triangles in world space, and their comparison with the result of another
/// program for the same file, independent of the order of triangles and vertices and of rounding.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "alhazen/geometry/polygon/free_diagonals.h"
#include "alhazen/geometry/polygon/triangulate.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen::testing {

/// Polygons of another program.
struct PolygonSoup {
    std::vector<Vec3> corners;
    std::vector<std::size_t> ends;  ///< [polygon] one past its last corner
};

/// Adds the triangles of an object and its parts, under a transform.
inline void add_triangles(const SceneDescription& scene, const ObjectDescription& object,
                          const Affine& world_from_object, TriangleMesh& soup, int depth = 0) {
    if (depth > 64) return;
    for (const Part& part : object.parts) {
        const Affine world_from_part = world_from_object * part.object_from_part;
        if (const auto* inner = std::get_if<ObjectIndex>(&part.what)) {
            add_triangles(scene, scene.objects.at(std::size_t(*inner)), world_from_part, soup,
                          depth + 1);
        } else if (const auto* index = std::get_if<MeshIndex>(&part.what)) {
            const TriangleMesh& mesh = *scene.meshes.at(std::size_t(*index)).mesh;
            const std::uint32_t first = std::uint32_t(soup.positions.size());
            for (const Vec3& p : mesh.positions) soup.positions.push_back(world_from_part.point(p));
            const bool mirrored = determinant(world_from_part.linear) < 0;
            for (const auto& [a, b, c] : mesh.triangles) {
                soup.triangles.push_back(
                    {first + a, first + (mirrored ? c : b), first + (mirrored ? b : c)});
            }
        }
    }
}

/// Numbers of positions; equal positions have equal numbers.
class Places {
  public:
    explicit Places(const TriangleMesh& mesh) {
        for (const auto& t : mesh.triangles) {
            for (const std::uint32_t i : t) positions_.push_back(mesh.positions[i]);
        }
        const auto less = [](const Vec3& a, const Vec3& b) {
            return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
        };
        std::sort(positions_.begin(), positions_.end(), less);
        positions_.erase(std::unique(positions_.begin(), positions_.end()), positions_.end());
    }
    /// The number of the nearest position within `distance`, or -1.
    [[nodiscard]] std::int64_t nearest(const Vec3& p, double distance) const {
        auto at = std::lower_bound(positions_.begin(), positions_.end(), p.x - distance,
                                   [](const Vec3& a, double x) { return a.x < x; });
        std::int64_t best = -1;
        double least = distance;
        for (; at != positions_.end() && at->x <= p.x + distance; ++at) {
            const double d = length(*at - p);
            if (d > least || (d == least && best >= 0)) continue;
            least = d;
            best = at - positions_.begin();
        }
        return best;
    }
    [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }

  private:
    std::vector<Vec3> positions_;
};

using Triple = std::array<std::uint32_t, 3>;

/// Rotates each triple to begin with its smallest number and sorts the triples; removes those
/// without three different numbers.
inline std::vector<Triple> sorted_set(std::vector<Triple> triples) {
    std::erase_if(triples,
                  [](const Triple& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    for (Triple& t : triples) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triples.begin(), triples.end());
    return triples;
}

/// Describes the difference between the triangles of `ours` and of `theirs`, triangulated; empty:
/// none.
inline std::string difference(const TriangleMesh& ours, const PolygonSoup& theirs,
                              double relative_distance = 1e-5) {
    Box3 box;
    for (const auto& t : ours.triangles) {
        for (const std::uint32_t i : t) box.include(ours.positions[i]);
    }
    const double distance =
        relative_distance * std::max(max_component(abs(box.lo)), max_component(abs(box.hi)));
    const Places places(ours);
    std::vector<Triple> mine;
    for (const auto& t : ours.triangles) {
        Triple triple{};
        for (std::size_t k = 0; k < 3; ++k) {
            triple[k] = std::uint32_t(places.nearest(ours.positions[t[k]], 0.0));
        }
        mine.push_back(triple);
    }
    std::vector<Triple> other;
    std::vector<std::uint32_t> polygon;
    std::vector<PolygonTriangles> polygons;
    std::size_t begin = 0, lost = 0;
    for (const std::size_t end : theirs.ends) {
        polygon.clear();
        for (std::size_t c = begin; c < end; ++c) {
            const std::int64_t place = places.nearest(theirs.corners[c], distance);
            if (place >= 0) polygon.push_back(std::uint32_t(place));
        }
        if (polygon.size() != end - begin) {
            ++lost;
        } else if (polygon.size() >= 3) {
            const std::size_t first = other.size();
            triangulate(places.positions(), polygon, other);
            if (polygon.size() > 3) polygons.push_back({first, other.size()});
        }
        begin = end;
    }
    std::vector<Triple> freed = other;
    free_diagonals(places.positions(), polygons, freed);
    mine = sorted_set(std::move(mine));
    other = sorted_set(std::move(other));
    // Importers free diagonals within each mesh, not over the whole model.
    if (lost == 0 && (mine == other || mine == sorted_set(std::move(freed)))) return {};
    std::vector<Triple> only_mine, only_other;
    std::set_difference(mine.begin(), mine.end(), other.begin(), other.end(),
                        std::back_inserter(only_mine));
    std::set_difference(other.begin(), other.end(), mine.begin(), mine.end(),
                        std::back_inserter(only_other));
    return std::to_string(mine.size()) + " triangles here, " + std::to_string(other.size()) +
           " there; only here " + std::to_string(only_mine.size()) + ", only there " +
           std::to_string(only_other.size()) + "; polygons with places of their own there " +
           std::to_string(lost);
}

}  // namespace alhazen::testing
