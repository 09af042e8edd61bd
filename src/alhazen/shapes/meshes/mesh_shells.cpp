#include "alhazen/shapes/meshes/mesh_shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "alhazen/base/disjoint_sets.h"
#include "alhazen/base/interruptible_sort.h"
#include "alhazen/geometry/polygon/merged_positions.h"
#include "alhazen/math/orientation.h"
#include "alhazen/shapes/meshes/mesh_edges.h"

namespace alhazen {

namespace {

using Corners = std::array<std::uint32_t, 3>;

struct Shells : MeshShells {
    std::vector<std::uint32_t> merged;  ///< [vertex] the one that replaces it
};

/// The shells of triangles whose vertices are first replaced by those of `merged`.
Shells shells_of(const TriangleMesh& mesh, std::vector<std::uint32_t> merged) {
    struct Edge {
        std::uint32_t higher, triangle;
    };
    const auto each_edge = [&](const auto& visit) {
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const Corners& t = mesh.triangles[i];
            for (int k = 0; k < 3; ++k) {
                const auto [lo, hi] = std::minmax({merged[t[k]], merged[t[k == 2 ? 0 : k + 1]]});
                // Sides without length connect nothing.
                if (mesh.positions[lo] != mesh.positions[hi]) visit(lo, Edge{hi, i});
            }
        }
    };
    // Edges by their lower vertex.
    std::vector<std::size_t> ends(mesh.positions.size() + 1, 0);
    each_edge([&](std::uint32_t lower, const Edge&) { ++ends[lower + 1]; });
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<Edge> edges(ends.back());
    each_edge([&](std::uint32_t lower, const Edge& edge) { edges[ends[lower]++] = edge; });

    DisjointSets joined(mesh.triangles.size());
    std::size_t first = 0;
    for (const std::size_t end : ends) {
        const auto at = [&](std::size_t i) {
            return edges.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::sort(at(first), at(end),
                  [](const Edge& a, const Edge& b) { return a.higher < b.higher; });
        for (std::size_t i = first + 1; i < end; ++i) {
            if (edges[i].higher != edges[i - 1].higher) continue;
            joined.unite(edges[i].triangle, edges[i - 1].triangle);
        }
        first = end;
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    Shells shells{{std::vector<std::uint32_t>(mesh.triangles.size(), kNone)}, std::move(merged)};
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        std::uint32_t& number = shells.of_triangle[joined.find(i)];
        if (number == kNone) number = shells.count++;
        shells.of_triangle[i] = number;
    }
    return shells;
}

Shells shells_of(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> apart(mesh.positions.size());
    std::iota(apart.begin(), apart.end(), 0u);
    Shells shells = shells_of(mesh, std::move(apart));
    if (shells.count > 1) shells = shells_of(mesh, merged_positions(mesh.positions));
    return shells;
}

/// [vertex] True if shells touch in it.
std::vector<bool> touching_vertices(const TriangleMesh& mesh, const Shells& shells) {
    std::vector<std::uint32_t> first(mesh.positions.size(), shells.count);
    std::vector<bool> touching(mesh.positions.size(), false);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = mesh.triangles[i];
        // A triangle that is a point is a shell of its own.
        if (mesh.positions[a] == mesh.positions[b] && mesh.positions[b] == mesh.positions[c]) {
            continue;
        }
        for (const std::uint32_t corner : {a, b, c}) {
            const std::uint32_t v = shells.merged[corner];
            if (first[v] == shells.count) first[v] = shells.of_triangle[i];
            if (first[v] != shells.of_triangle[i]) touching[v] = true;
        }
    }
    for (std::size_t v = 0; v < touching.size(); ++v) touching[v] = touching[shells.merged[v]];
    return touching;
}

/// [shell] True if its signed volume is certain to be negative.
std::vector<bool> inward_shells(const TriangleMesh& mesh, const Shells& shells) {
    struct Sum {
        const Vec3* origin = nullptr;
        double volume = 0, size = 0;  ///< six times
    };
    std::vector<Sum> sums(shells.count);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Corners& t = mesh.triangles[i];
        Sum& sum = sums[shells.of_triangle[i]];
        if (sum.origin == nullptr) sum.origin = &mesh.positions[t[0]];
        const Vec3 a = mesh.positions[t[0]] - *sum.origin;
        const Vec3 area =
            cross(mesh.positions[t[1]] - *sum.origin, mesh.positions[t[2]] - *sum.origin);
        sum.volume += dot(a, area);
        sum.size += length(a) * length(area);
    }
    const double rounding = (16.0 + static_cast<double>(mesh.triangles.size())) *
                            std::numeric_limits<double>::epsilon();
    std::vector<bool> inward;
    for (const Sum& sum : sums) inward.push_back(sum.volume < -rounding * sum.size);
    return inward;
}

Vec2 along_x(const Vec3& p) {
    return {p.y, p.z};
}

/// How often the line through `q` along x passes the triangle from its back to its front, for
/// x > q.x; on edges half open, so that a line passes one of two neighbours.
int passes_ahead(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& q) {
    const auto passes = [&](const Vec3& from, const Vec3& to) {
        const bool up = from.z <= q.z;
        if (up == (to.z <= q.z)) return 0;
        const int side = orientation(along_x(from), along_x(to), along_x(q));
        return up ? int(side > 0) : -int(side < 0);
    };
    const int winding = passes(a, b) + passes(b, c) + passes(c, a);
    if (winding == 0) return 0;
    return winding * dot(cross(b - a, c - a), q - a) < 0.0 ? winding : 0;
}

/// True if `q` lies on the triangle for all that rounding lets one tell, or beside it in its plane
/// and box.
bool touches(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& q) {
    Box3 box;
    for (const Vec3& v : {a, b, c}) box.include(v);
    const Vec3 under = q - box.lo, over = box.hi - q;
    if (std::min({under.x, under.y, under.z, over.x, over.y, over.z}) < 0.0) return false;
    const Vec3 area = cross(b - a, c - a);
    const double size = length(area);
    // A triangle without area is part of the sides of others.
    return size > 0.0 && std::abs(dot(area, q - a)) <= 1e-12 * size * length(box.size());
}

/// True if some of the inward shells lies where the winding number of the others is not positive.
/// Each is asked at a vertex; where that lies on another shell it is taken for a cavity.
bool some_is_no_cavity(const TriangleMesh& mesh, const Shells& shells,
                       const std::vector<bool>& inward) {
    struct Entry {
        double low, high;                ///< z
        std::uint32_t triangle, vertex;  ///< the latter of those asked
    };
    const std::vector<bool> touching = touching_vertices(mesh, shells);
    const auto by_height = [](const Entry& a, const Entry& b) { return a.low < b.low; };
    std::vector<Entry> triangles, asked;
    std::vector<bool> is_asked(shells.count, false);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = mesh.triangles[i];
        const double za = mesh.positions[a].z, zb = mesh.positions[b].z, zc = mesh.positions[c].z;
        triangles.push_back({std::min({za, zb, zc}), std::max({za, zb, zc}), i, a});
        const std::uint32_t shell = shells.of_triangle[i];
        if (!inward[shell]) continue;
        for (const std::uint32_t v : mesh.triangles[i]) {
            if (touching[v] || is_asked[shell]) continue;
            is_asked[shell] = true;
            asked.push_back({mesh.positions[v].z, mesh.positions[v].z, i, v});
        }
    }
    interruptible_sort(triangles.begin(), triangles.end(), by_height);
    interruptible_sort(asked.begin(), asked.end(), by_height);
    std::vector<Entry> here;
    auto next = triangles.begin();
    for (const Entry& at : asked) {
        interruption_point();
        for (; next != triangles.end() && next->low <= at.low; ++next) here.push_back(*next);
        std::erase_if(here, [&](const Entry& e) { return e.high < at.low; });
        const Vec3& q = mesh.positions[at.vertex];
        int winding = 0;
        bool on_other = false;
        for (const Entry& e : here) {
            if (shells.of_triangle[e.triangle] == shells.of_triangle[at.triangle]) continue;
            const Corners& t = mesh.triangles[e.triangle];
            const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]],
                       &c = mesh.positions[t[2]];
            winding += passes_ahead(a, b, c, q);
            on_other = on_other || touches(a, b, c, q);
        }
        if (winding <= 0 && !on_other) return true;
    }
    return false;
}

}  // namespace

MeshShells mesh_shells(const TriangleMesh& mesh) {
    return shells_of(mesh);
}

bool has_inward_shell(const TriangleMesh& mesh) {
    const Shells shells = shells_of(mesh);
    const std::vector<bool> inward = inward_shells(mesh, shells);
    if (std::find(inward.begin(), inward.end(), true) == inward.end()) return false;
    // Edges are sorted, which takes longer.
    return mesh_edges(mesh).oriented() && some_is_no_cavity(mesh, shells, inward);
}

}  // namespace alhazen
