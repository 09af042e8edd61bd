#pragma once
/// Patches for tests: the models of the test data, and patches whose derivatives vanish.

#include <cmath>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "alhazen/shapes/patches/patch_tree.h"
#include "support/test_data.h"

namespace alhazen::testing {

inline std::vector<BezierNet> patch_model(const std::string& name) {
    std::ifstream in(test_data() / "patches" / name);
    int count = 0;
    in >> count;
    std::vector<BezierNet> nets;
    for (int k = 0; k < count; ++k) {
        int n = 0, m = 0;
        in >> n >> m;
        std::vector<Vec3> points(static_cast<std::size_t>((n + 1) * (m + 1)));
        for (Vec3& p : points) in >> p.x >> p.y >> p.z;
        nets.push_back(bezier_net(n, m, points));
    }
    return nets;
}

inline PatchTree patch_tree(std::span<const BezierNet> nets) {
    std::vector<BezierPiece> pieces;
    for (const BezierNet& net : nets) {
        pieces.push_back({.net = net, .part = static_cast<std::uint32_t>(pieces.size())});
    }
    return PatchTree(pieces);
}

/// A curve with a cusp, extruded along y from 0 to 3: x = 3 u (1 - u)^2 + u^3, z = 3 u (1 - u).
inline BezierNet cusp_patch() {
    std::vector<Vec3> points;
    for (const Vec2& p : {Vec2{0, 0}, Vec2{1, 1}, Vec2{0, 1}, Vec2{1, 0}}) {
        for (int j = 0; j < 4; ++j) points.push_back({p.x, double(j), p.y});
    }
    return bezier_net(3, 3, points);
}
/// x of the cusp at a height z, in its half with the smaller u.
inline double cusp_x(double z) {
    const double u = 0.5 * (1.0 - std::sqrt(1.0 - 4.0 / 3.0 * z));
    return 3.0 * u * (1.0 - u) * (1.0 - u) + u * u * u;
}

}  // namespace alhazen::testing
