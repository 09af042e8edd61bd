#include "alhazen/shapes/meshes/mesh_edges.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "alhazen/base/interruptible_sort.h"
#include "alhazen/geometry/polygon/merged_positions.h"

namespace alhazen {

namespace {

/// An edge, lower vertex first, and whether the triangle traverses it from the lower to the higher
/// vertex.
struct DirectedEdge {
    std::uint64_t vertices;
    bool upward;
};

std::vector<DirectedEdge> sorted_edges(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> merged = merged_positions(mesh.positions);
    constexpr std::size_t kOften = 1u << 16;
    std::vector<DirectedEdge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) {
        if (edges.size() % kOften < 3) interruption_point();
        const std::uint32_t v[3] = {merged[triangle[0]], merged[triangle[1]], merged[triangle[2]]};
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;  // a segment: never hit
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t from = v[k], to = v[k == 2 ? 0 : k + 1];
            const auto [lo, hi] = std::minmax(from, to);
            edges.push_back({std::uint64_t{lo} << 32 | hi, from < to});
        }
    }
    interruptible_sort(
        edges.begin(), edges.end(),
        [](const DirectedEdge& a, const DirectedEdge& b) { return a.vertices < b.vertices; });
    return edges;
}

std::string point_text(const Vec3& p) {
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "(%.9g, %.9g, %.9g)", p.x, p.y, p.z);
    return text.data();
}

}  // namespace

MeshEdges mesh_edges(const TriangleMesh& mesh) {
    const std::vector<DirectedEdge> edges = sorted_edges(mesh);
    MeshEdges found;
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i, upward = 0;
        for (; end < edges.size() && edges[end].vertices == edges[i].vertices; ++end) {
            upward += edges[end].upward;
        }
        const std::size_t triangles = end - i;
        ++found.count;
        if (triangles % 2 == 0) {
            found.crowded += triangles > 2;
            found.turned += 2 * upward != triangles;
        } else {
            ++found.open;
            const Vec3& a = mesh.positions[edges[i].vertices >> 32];
            const Vec3& b = mesh.positions[edges[i].vertices & 0xffffffffu];
            if (found.first_open.size() < MeshEdges::kMostShown) found.first_open.push_back({a, b});
            found.open_box.include(a);
            found.open_box.include(b);
        }
        i = end;
    }
    return found;
}

std::string MeshEdges::description() const {
    if (count == 0) return "no triangles";
    if (open == 0) {
        return turned == 0 ? "closed"
                           : "closed, but the triangles of " + std::to_string(turned) +
                                 " edges face opposite ways";
    }
    std::string text = std::to_string(open) + " of " + std::to_string(count) + " edges " +
                       (open == 1 ? "is open: " : "are open: ");
    for (std::size_t i = 0; i < first_open.size(); ++i) {
        const auto& [from, to] = first_open[i];
        text += (i == 0 ? "" : ", ") + point_text(from) + " to " + point_text(to);
    }
    if (open > first_open.size()) {
        text += " and " + std::to_string(open - first_open.size()) + " more, all between " +
                point_text(open_box.lo) + " and " + point_text(open_box.hi);
    }
    return text;
}

}  // namespace alhazen
