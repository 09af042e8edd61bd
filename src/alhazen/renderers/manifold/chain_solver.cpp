#include "alhazen/renderers/manifold/chain_solver.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

constexpr int kMostSteps = 16;
constexpr int kMostHalvings = 4;
constexpr int kFreeSteps = 6;
constexpr double kFreeRise = 2.0;
/// Largest angle between the last direction and that to the light, in radians.
constexpr double kConverged = 1e-10;
/// Largest angle accepted when rounding prevents smaller ones.
constexpr double kGoodEnough = 1e-7;

/// The direction from the last vertex to the end.
struct Aim {
    Vec3 direction;
    double inverse_distance = 0;  ///< 0: infinitely far
};

Aim aim_from(const Chain& chain, const ChainEnd& end) {
    if (end.infinite) return {end.at, 0.0};
    const Vec3 way = end.at - chain.last().surface.point;
    const double distance = length(way);
    return {way / distance, 1.0 / distance};
}

/// The error of a chain: the angle, along two vectors perpendicular to the aim.
struct Miss {
    Aim aim;
    Vec3 a, b;
    Vec2 angle;

    Miss(const Chain& chain, const ChainEnd& end) : aim(aim_from(chain, end)) {
        a = perpendicular(aim.direction);
        b = cross(aim.direction, a);
        const Vec3& leaving = chain.last().leaving;
        const Vec2 sine{dot(leaving, a), dot(leaving, b)};
        const double size = std::hypot(sine.x, sine.y);
        const double scale =
            size > 1e-12 ? std::atan2(size, dot(leaving, aim.direction)) / size : 1.0;
        angle = scale * sine;
    }
    [[nodiscard]] double size() const { return std::hypot(angle.x, angle.y); }
    /// Derivative of the error by the first direction.
    [[nodiscard]] Vec2 change(const ChainSlope& slope, std::size_t k) const {
        const Vec3 turned = slope.direction[k] + aim.inverse_distance * slope.end[k];
        return {dot(turned, a), dot(turned, b)};
    }
};

/// The Newton step of the first direction towards error 0, as a step of the first vertex.
std::optional<Vec3> newton_step(const Miss& miss, const ChainSlope& slope) {
    const Vec2 c0 = miss.change(slope, 0), c1 = miss.change(slope, 1);
    const double determinant = c0.x * c1.y - c1.x * c0.y;
    if (!(std::abs(determinant) > 0.0)) return std::nullopt;
    const double s0 = (c1.x * miss.angle.y - c1.y * miss.angle.x) / determinant;
    const double s1 = (c0.y * miss.angle.x - c0.x * miss.angle.y) / determinant;
    const Vec3 step = s0 * slope.point[0] + s1 * slope.point[1];
    if (!is_finite(step)) return std::nullopt;
    return step;
}

}  // namespace

bool walk_to(const ChainTracer& tracer, const ShapeSurface& from, std::uint64_t part,
             const ChainIndices& indices, const ChainEnd& end, float time, Chain& chain) {
    Chain tried;
    double now = Miss(chain, end).size();
    for (int i = 0; i < kMostSteps && now > kConverged; ++i) {
        const std::optional<ChainSlope> slope = tracer.slope(chain, time);
        if (!slope) return false;
        const std::optional<Vec3> step = newton_step(Miss(chain, end), *slope);
        if (!step) return false;
        // The first steps may increase the error, to cross a fold in front of the solution.
        const double bound = i < kFreeSteps ? kFreeRise * now : now;
        const double reach = length(chain.at[0].surface.point - from.point);
        double share = std::min(1.0, reach / length(*step)), least = 0.0;
        bool better = false;
        for (int halved = 0; halved <= kMostHalvings && !better; ++halved, share *= 0.5) {
            const Vec3 to = chain.at[0].surface.point + share * *step - from.point;
            const double away = length(to);
            if (!(away > 0.0)) continue;
            if (!tracer.follow(from, to / away, chain.kind, part, indices, time, tried)) continue;
            least = Miss(tried, end).size();
            better = least < bound;
        }
        // Gives up when the error decreases too slowly.
        if (!better || (least > 0.999 * now && i >= kFreeSteps)) return now < kGoodEnough;
        chain = tried;
        now = least;
    }
    return now <= kGoodEnough;
}

double spread_ratio(const ChainTracer& tracer, const Chain& chain, const ChainEnd& end,
                    float time) {
    const std::optional<ChainSlope> slope = tracer.slope(chain, time);
    if (!slope) return 0.0;
    const Miss miss(chain, end);
    const Vec2 c0 = miss.change(*slope, 0), c1 = miss.change(*slope, 1);
    const double angles = std::abs(c0.x * c1.y - c1.x * c0.y);
    const double squared =
        end.infinite ? 1.0 : miss.aim.inverse_distance * miss.aim.inverse_distance;
    return angles > 0.0 && std::isfinite(angles) ? squared / angles : 0.0;
}

}  // namespace alhazen
