#include "alhazen/shapes/meshes/mesh_shells.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "alhazen/base/interruptible_sort.h"
#include "alhazen/geometry/polygon/merged_positions.h"
#include "alhazen/math/orientation.h"
#include "alhazen/shapes/meshes/mesh_edges.h"

namespace alhazen {

namespace {

using Corners = std::array<std::uint32_t, 3>;

struct Shells {
    std::vector<std::uint32_t> of_vertex;  ///< [vertex] its shell
    std::uint32_t count = 0;
};

/// The shells of triangles whose vertices are first replaced by those of `merged`.
Shells shells_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& merged) {
    std::vector<std::uint32_t> parent = merged;
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const Corners& t : mesh.triangles) {
        const std::uint32_t a = root(t[0]);
        parent[root(t[1])] = a;
        parent[root(t[2])] = a;
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    Shells shells{std::vector<std::uint32_t>(parent.size(), kNone)};
    for (const Corners& t : mesh.triangles) {
        std::uint32_t& number = shells.of_vertex[root(t[0])];
        if (number == kNone) number = shells.count++;
    }
    for (std::uint32_t v = 0; v < parent.size(); ++v) {
        shells.of_vertex[v] = shells.of_vertex[root(v)];
    }
    return shells;
}

Shells shells_of(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> apart(mesh.positions.size());
    std::iota(apart.begin(), apart.end(), 0u);
    Shells shells = shells_of(mesh, apart);
    if (shells.count > 1) shells = shells_of(mesh, merged_positions(mesh.positions));
    return shells;
}

/// [shell] True if its signed volume is certain to be negative.
std::vector<bool> inward_shells(const TriangleMesh& mesh, const Shells& shells) {
    struct Sum {
        const Vec3* origin = nullptr;
        double volume = 0, size = 0;  ///< six times
    };
    std::vector<Sum> sums(shells.count);
    for (const Corners& t : mesh.triangles) {
        Sum& sum = sums[shells.of_vertex[t[0]]];
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

/// True if some of the inward shells lies where the winding number of the others is not positive.
bool some_is_no_cavity(const TriangleMesh& mesh, const Shells& shells,
                       const std::vector<bool>& inward) {
    struct Entry {
        double low, high;  ///< z
        std::uint32_t triangle;
    };
    const auto by_height = [](const Entry& a, const Entry& b) { return a.low < b.low; };
    std::vector<Entry> triangles, asked;
    std::vector<bool> is_asked(shells.count, false);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = mesh.triangles[i];
        const double za = mesh.positions[a].z, zb = mesh.positions[b].z, zc = mesh.positions[c].z;
        triangles.push_back({std::min({za, zb, zc}), std::max({za, zb, zc}), i});
        const std::uint32_t shell = shells.of_vertex[a];
        if (!inward[shell] || is_asked[shell]) continue;
        is_asked[shell] = true;
        asked.push_back({za, za, i});
    }
    interruptible_sort(triangles.begin(), triangles.end(), by_height);
    interruptible_sort(asked.begin(), asked.end(), by_height);
    std::vector<Entry> here;
    auto next = triangles.begin();
    for (const Entry& at : asked) {
        interruption_point();
        for (; next != triangles.end() && next->low <= at.low; ++next) here.push_back(*next);
        std::erase_if(here, [&](const Entry& e) { return e.high < at.low; });
        const std::uint32_t vertex = mesh.triangles[at.triangle][0];
        int winding = 0;
        for (const Entry& e : here) {
            const auto [a, b, c] = mesh.triangles[e.triangle];
            if (shells.of_vertex[a] == shells.of_vertex[vertex]) continue;
            winding += passes_ahead(mesh.positions[a], mesh.positions[b], mesh.positions[c],
                                    mesh.positions[vertex]);
        }
        if (winding <= 0) return true;
    }
    return false;
}

}  // namespace

bool has_inward_shell(const TriangleMesh& mesh) {
    const Shells shells = shells_of(mesh);
    const std::vector<bool> inward = inward_shells(mesh, shells);
    if (std::find(inward.begin(), inward.end(), true) == inward.end()) return false;
    // Edges are sorted, which takes longer.
    return mesh_edges(mesh).oriented() && some_is_no_cavity(mesh, shells, inward);
}

}  // namespace alhazen
