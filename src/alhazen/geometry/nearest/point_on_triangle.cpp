#include "alhazen/geometry/nearest/point_on_triangle.h"

#include <algorithm>
#include <limits>

namespace alhazen {

namespace {

/// The parameter, 0 to 1, of the nearest point between both ends.
double place_on_edge(const Vec3& from, const Vec3& begin, const Vec3& along) {
    const double squared = length_squared(along);
    if (!(squared > 0.0)) return 0.0;
    return std::clamp(dot(from - begin, along) / squared, 0.0, 1.0);
}

/// Computes the weights of the foot of the perpendicular, relative to the first corner.
struct Foot {
    Vec3 ab, ac, normal;
    double squared;  ///< squared length of the normal

    [[nodiscard]] Vec2 weights(const Vec3& offset) const {
        return {dot(cross(offset, ac), normal) / squared, dot(cross(ab, offset), normal) / squared};
    }
};

}  // namespace

PointOnTriangle nearest_on_triangle(const Vec3& from, const std::array<Vec3, 3>& corners) {
    const auto& [a, b, c] = corners;
    PointOnTriangle best;
    best.squared = std::numeric_limits<double>::infinity();
    const auto offer = [&](const Vec3& point, double u, double v) {
        const double squared = length_squared(from - point);
        if (squared < best.squared) best = {point, u, v, squared};
    };
    const Vec3 ab = b - a, ac = c - a, bc = c - b;

    // The foot is clearly inside: the edges are farther away.
    const Vec3 normal = cross(ab, ac);
    const Foot foot{ab, ac, normal, length_squared(normal)};
    if (foot.squared > 0.0) {
        Vec2 w = foot.weights(from - a);
        const Vec2 more = foot.weights((from - a) - (w.x * ab + w.y * ac));
        w.x += more.x;
        w.y += more.y;
        const double rest = 1.0 - w.x - w.y;
        if (w.x >= 0.0 && w.y >= 0.0 && rest >= 0.0) {
            offer(a + w.x * ab + w.y * ac, w.x, w.y);
            constexpr double kClear = 1e-6, kWide = 1e-6;
            const bool wide = foot.squared > kWide * length_squared(ab) * length_squared(ac);
            if (wide && std::min({w.x, w.y, rest}) > kClear) return best;
        }
    }
    // The edges, including their exact ends.
    const double on_ab = place_on_edge(from, a, ab);
    offer(on_ab < 1.0 ? a + on_ab * ab : b, on_ab, 0.0);
    const double on_ac = place_on_edge(from, a, ac);
    offer(on_ac < 1.0 ? a + on_ac * ac : c, 0.0, on_ac);
    const double on_bc = place_on_edge(from, b, bc);
    offer(on_bc < 1.0 ? b + on_bc * bc : c, 1.0 - on_bc, on_bc);
    return best;
}

}  // namespace alhazen
