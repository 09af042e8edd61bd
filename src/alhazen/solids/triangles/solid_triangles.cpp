#include "alhazen/solids/triangles/solid_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "alhazen/solids/solid_coordinates.h"
#include "alhazen/solids/triangles/collapsed_edges.h"
#include "alhazen/solids/triangles/surface_cells.h"

namespace alhazen {

namespace {

/// The mesh of the faces of cells.
class SurfaceMesh {
  public:
    SurfaceMesh(const SurfaceCells& cells, SolidCoordinates* coordinates, TriangleMesh& mesh)
        : cells_(cells), coordinates_(coordinates), mesh_(mesh) {}

    void make() {
        numbers_.assign(cells_.vertex_count(), kNone);
        for (const SurfaceEdge& edge : cells_.edges()) {
            for (const std::uint32_t vertex : edge.vertices) {
                std::uint32_t& number = numbers_[vertex];
                if (number != kNone) continue;
                number = static_cast<std::uint32_t>(mesh_.positions.size());
                const SurfaceVertex& v = cells_.vertex(vertex);
                add_vertex(v.point, v.normal, v.material);
                points_.push_back(number);
                is_edge_.push_back(!v.smooth);
            }
        }
        for (const SurfaceEdge& edge : cells_.edges()) add_face(edge);
    }
    /// [vertex of the mesh] the first vertex at its point.
    [[nodiscard]] std::vector<std::uint32_t> take_points() { return std::move(points_); }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    void add_vertex(const Vec3& point, const Vec3& normal, std::uint32_t material) {
        mesh_.positions.push_back(point);
        mesh_.normals.push_back(normal);
        mesh_.uvs.push_back({0, 0});
        mesh_.vertex_materials.push_back(material);
    }
    void add_face(const SurfaceEdge& edge) {
        const SurfaceFace made = cells_.face(edge);
        std::array<std::uint32_t, 4> corners{};
        for (std::size_t k = 0; k < made.count; ++k) {
            corners[k] = corner(numbers_[made.vertices[k]], edge.met);
        }
        for (std::size_t k = 0; k < made.triangle_count(); ++k) {
            const auto& t = made.triangles[k];
            mesh_.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
        }
    }
    /// The vertex of a sheet for a face: a copy if the surface has an edge, another material or
    /// other texture coordinates there.
    std::uint32_t corner(std::uint32_t own, const SurfaceCrossing& met) {
        const bool edge = is_edge_[own];
        const bool fits = !edge && mesh_.vertex_materials[own] == met.material;
        if (!coordinates_) return fits ? own : copy(own, met);
        const Vec2 uv = coordinates_->uv(mesh_.positions[own], met.point, met.place);
        if (!fits) {
            const std::uint32_t next = copy(own, met);
            mesh_.uvs[next] = uv;
            return next;
        }
        return coordinates_->vertex(own, met.place, uv, mesh_, [&] { return copy(own, met); });
    }
    std::uint32_t copy(std::uint32_t own, const SurfaceCrossing& met) {
        const bool edge = is_edge_[own];
        const auto next = static_cast<std::uint32_t>(mesh_.positions.size());
        const Vec3 point = mesh_.positions[own];
        add_vertex(point, edge ? met.normal : mesh_.normals[own], met.material);
        is_edge_.push_back(edge);
        points_.push_back(points_[own]);
        return next;
    }

    const SurfaceCells& cells_;
    SolidCoordinates* coordinates_;
    TriangleMesh& mesh_;
    std::vector<std::uint32_t> numbers_;  ///< [vertex of the cells] that of the mesh
    std::vector<bool> is_edge_;           ///< [vertex of the mesh]
    std::vector<std::uint32_t> points_;   ///< [vertex of the mesh]
};

}  // namespace

bool make_solid_triangles(const IsolatedSolid& solid, double tolerance, std::uint64_t max_triangles,
                          TriangleMesh& mesh, bool with_uvs, SolidTrianglesReport* report) {
    mesh = TriangleMesh{};
    const Box3 box = solid.box();
    if (box.empty()) return true;
    constexpr double kFirstCells = 24;
    constexpr int kMostHalvings = 26;
    // Of the tolerance half is for the cells and half for the merging.
    const double smallest = 0.5 * tolerance / std::sqrt(3.0) * (1.0 - 1e-9);
    const double cell = std::max(max_component(box.size()) / kFirstCells, smallest);
    int halvings = 0;
    while (std::ldexp(cell, -halvings) > smallest) {
        if (++halvings > kMostHalvings) return false;
    }
    std::vector<std::uint32_t> points;
    {
        // Cells and coordinates are freed before triangles are merged.
        std::optional<SolidCoordinates> coordinates;
        if (with_uvs) coordinates.emplace(solid);
        SolidCoordinates* const places = coordinates ? &*coordinates : nullptr;
        SurfaceCells cells(solid, cell, halvings, tolerance, places);
        if (!cells.divide(max_triangles)) {
            if (report != nullptr) report->larger_tolerance = cells.larger_tolerance();
            return false;
        }
        if (report != nullptr) report->lost_parts = cells.lost_parts();
        SurfaceMesh made(cells, places, mesh);
        made.make();
        points = made.take_points();
    }
    constexpr double kCoordinates = 1.0 / 512;
    collapse_edges(mesh, std::move(points), 0.5 * tolerance, kCoordinates);
    return true;
}

}  // namespace alhazen
