#include "alhazen/shapes/polygons/face_loops.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

namespace alhazen {

namespace {

/// Twice the area of the loop, along its normal.
Vec3 area_vector(const std::vector<Vec3>& loop) {
    Vec3 sum;
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
        sum += cross(loop[k] - loop[0], loop[k + 1] - loop[0]);
    }
    return sum;
}

/// Replaces corners near an earlier one by it, then drops repeated corners, faces without area and
/// those of planes given twice.
void weld(std::vector<FaceLoop>& loops) {
    constexpr double kNear = 1e-9;
    Box3 box;
    for (const FaceLoop& loop : loops) {
        for (const Vec3& p : loop.corners) box.include(p);
    }
    const double near = kNear * length(box.size());
    std::vector<Vec3> kept;
    for (FaceLoop& loop : loops) {
        std::vector<Vec3>& corners = loop.corners;
        for (Vec3& p : corners) {
            const auto same = std::find_if(kept.begin(), kept.end(),
                                           [&](const Vec3& q) { return length(p - q) <= near; });
            if (same != kept.end()) {
                p = *same;
            } else {
                kept.push_back(p);
            }
        }
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        while (corners.size() > 1 && corners.back() == corners.front()) corners.pop_back();
    }
    std::set<std::vector<std::array<double, 3>>> seen;
    std::erase_if(loops, [&](const FaceLoop& loop) {
        std::vector<std::array<double, 3>> corners;
        for (const Vec3& p : loop.corners) corners.push_back({p.x, p.y, p.z});
        std::sort(corners.begin(), corners.end());
        return corners.size() < 3 || !seen.insert(std::move(corners)).second;
    });
}

/// True if each edge is used once in each direction.
bool is_closed(const std::vector<FaceLoop>& loops) {
    using Edge = std::array<double, 6>;
    std::vector<Edge> edges, opposite;
    for (const FaceLoop& loop : loops) {
        const std::size_t n = loop.corners.size();
        for (std::size_t k = 0; k < n; ++k) {
            const Vec3 &a = loop.corners[k], &b = loop.corners[(k + 1) % n];
            edges.push_back({a.x, a.y, a.z, b.x, b.y, b.z});
            opposite.push_back({b.x, b.y, b.z, a.x, a.y, a.z});
        }
    }
    std::sort(edges.begin(), edges.end());
    std::sort(opposite.begin(), opposite.end());
    const bool once = std::adjacent_find(edges.begin(), edges.end()) == edges.end();
    return !edges.empty() && once && edges == opposite;
}

}  // namespace

std::vector<FaceLoop> face_loops(const BoxShape& box) {
    std::vector<FaceLoop> loops;
    for (std::uint32_t face = 0; face < 6; ++face) {
        const int axis = static_cast<int>(face / 2), u = (axis + 1) % 3, v = (axis + 2) % 3;
        const bool high = face % 2 == 1;
        FaceLoop& loop = loops.emplace_back();
        loop.face = face;
        loop.corners.resize(4);
        loop.normal[axis] = high ? 1.0 : -1.0;
        for (std::size_t k = 0; k < 4; ++k) {
            Vec3& p = loop.corners[high ? k : 3 - k];
            p[axis] = high ? box.hi[axis] : box.lo[axis];
            p[u] = k == 1 || k == 2 ? box.hi[u] : box.lo[u];
            p[v] = k >= 2 ? box.hi[v] : box.lo[v];
        }
    }
    return loops;
}

std::optional<std::vector<FaceLoop>> face_loops(const Polyhedron& solid) {
    const ConvexCorners all = convex_corners(solid.faces);
    if (!all.bounded) return std::nullopt;
    std::vector<FaceLoop> loops;
    auto first = all.corners.begin();
    for (std::uint32_t face = 0; face < all.face_ends.size(); ++face) {
        const auto end = all.corners.begin() + static_cast<std::ptrdiff_t>(all.face_ends[face]);
        std::vector<Vec3> corners(first, end);
        first = end;
        if (corners.size() < 3) continue;
        const Vec3& normal = solid.faces[face].normal;
        if (dot(area_vector(corners), normal) < 0.0) std::reverse(corners.begin(), corners.end());
        loops.push_back({face, normal, std::move(corners)});
    }
    return loops;
}

std::optional<std::vector<FaceLoop>> closed_face_loops(const Polyhedron& solid) {
    std::optional<std::vector<FaceLoop>> loops = face_loops(solid);
    if (!loops) return std::nullopt;
    weld(*loops);
    if (!is_closed(*loops)) return std::nullopt;
    return loops;
}

}  // namespace alhazen
