#include "alhazen/shapes/polygons/face_loops.h"

#include <algorithm>

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

}  // namespace alhazen
