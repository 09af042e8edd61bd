#include "alhazen/renderers/manifold/sphere_chains.h"

#include <algorithm>
#include <cmath>

#include "alhazen/geometry/mirrors/alhazens_problem.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

/// The angle at the centre between the point and the light, along a chain whose rays pass the
/// centre at distance b = sin(incidence); for radius 1.
struct BallAngle {
    double index;     ///< at least 1
    double from, to;  ///< distances of the ends from the centre; infinite: 0 stands for 1 / d
    bool infinite = false;

    [[nodiscard]] double operator()(double b) const {
        const double entered = std::asin(b / index);
        const double behind = infinite ? 0.0 : std::asin(b / to);
        return kPi + 2.0 * (std::asin(b) - entered) - std::asin(b / from) - behind;
    }
    /// Its derivative times sqrt(1 - b^2), which is finite and has the same sign.
    [[nodiscard]] double slope(double b) const {
        const double rest = 1.0 - b * b;
        const auto share = [&](double c) { return std::sqrt(rest / (c * c - b * b)); };
        return 2.0 - 2.0 * share(index) - share(from) - (infinite ? 0.0 : share(to));
    }
    /// Its second derivative over b, scaled likewise; increasing in b.
    [[nodiscard]] double curvature(double b) const {
        const double rest = 1.0 - b * b;
        const auto share = [&](double c) { return std::pow(rest / (c * c - b * b), 1.5); };
        return 2.0 - 2.0 * share(index) - share(from) - (infinite ? 0.0 : share(to));
    }
};

/// The zero of a function with different signs at both ends.
template <class F>
double bisected(F&& f, double lo, double hi) {
    const bool rises = f(lo) < 0.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (lo + hi);
        ((f(middle) < 0.0) == rises ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
}

}  // namespace

ChainSeeds reflections_by_sphere(const BoundingSphere& sphere, const Vec3& from,
                                 const ChainEnd& end) {
    ChainSeeds seeds;
    const bool outside = length(from - sphere.center) > sphere.radius;
    const MirrorPoints points = reflecting_points(sphere.center, sphere.radius,
                                                  outside ? MirrorFace::Outer : MirrorFace::Inner,
                                                  {from, false}, {end.at, end.infinite});
    for (int i = 0; i < points.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!points.on_ring[k]) seeds.push_back(normalize(points.points[k] - from));
    }
    return seeds;
}

ChainSeeds refractions_by_ball(const BoundingSphere& sphere, double index, const Vec3& from,
                               const ChainEnd& end) {
    ChainSeeds seeds;
    const Vec3 f = (from - sphere.center) / sphere.radius;
    const Vec3 t = end.infinite ? end.at : (end.at - sphere.center) / sphere.radius;
    BallAngle angle{index, length(f), length(t), end.infinite};
    if (!(angle.from > 1.0) || !(end.infinite || angle.to > 1.0) || !(index >= 1.0)) return seeds;
    const Vec3 to_point = f / angle.from, to_light = t / length(t);
    const double between = std::atan2(length(cross(to_point, to_light)), dot(to_point, to_light));
    // Towards the light, in the plane of both, perpendicular to the direction of the centre.
    const Vec3 side = to_light - dot(to_light, to_point) * to_point;
    const double size = length(side);
    const Vec3 across = size > 1e-12 ? side / size : perpendicular(to_point);
    constexpr double kEdge = 1.0 - 1e-12;
    InlineVector<double, 4> ends;
    ends.push_back(0.0);
    if (angle.slope(0.0) < 0.0 || angle.curvature(0.0) < 0.0) {
        const double turn = angle.curvature(0.0) < 0.0 && angle.curvature(kEdge) > 0.0
                                ? bisected([&](double b) { return angle.curvature(b); }, 0.0, kEdge)
                                : 0.0;
        const auto slope = [&](double b) { return angle.slope(b); };
        if (angle.slope(0.0) > 0.0 && angle.slope(turn) < 0.0) {
            ends.push_back(bisected(slope, 0.0, turn));
        }
        if (angle.slope(turn) < 0.0 && angle.slope(kEdge) > 0.0) {
            ends.push_back(bisected(slope, turn, kEdge));
        }
    }
    ends.push_back(kEdge);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double lo = ends[i], hi = ends[i + 1];
        // Chains on either side of the ball.
        for (const double wanted : {between, 2.0 * kPi - between}) {
            const auto miss = [&](double b) { return angle(b) - wanted; };
            if (!(miss(lo) * miss(hi) < 0.0) || seeds.full()) continue;
            const double sine = bisected(miss, lo, hi) / angle.from;
            const Vec3 outward = wanted == between ? across : -across;
            seeds.push_back(sine * outward - std::sqrt(1.0 - sine * sine) * to_point);
        }
    }
    return seeds;
}

ChainSeeds reflections_by_plane(const Vec3& point, const Vec3& normal, const Vec3& from,
                                const ChainEnd& end) {
    ChainSeeds seeds;
    const double height = dot(from - point, normal);
    const double other = end.infinite ? dot(end.at, normal) : dot(end.at - point, normal);
    if (!(height * other > 0.0)) return seeds;
    const Vec3 image = end.at - (2.0 * other) * normal;
    seeds.push_back(normalize(end.infinite ? image : image - from));
    return seeds;
}

ChainSeeds refractions_by_plane(const Vec3& point, const Vec3& normal, double eta, const Vec3& from,
                                const ChainEnd& end) {
    ChainSeeds seeds;
    const double signed_height = dot(from - point, normal);
    // Oriented so that the light is below.
    const Vec3 up = signed_height > 0.0 ? normal : -normal;
    const double height = std::abs(signed_height);
    const Vec3 way = end.infinite ? end.at : end.at - from;
    const double drop = -dot(way, up);
    const Vec3 side = way + drop * up;
    const double across = length(side);
    const Vec3 along = across > 0.0 ? side / across : perpendicular(up);
    if (end.infinite) {
        // Snell's law: n1 sin 1 = n2 sin 2.
        const double sine = across / length(way) / eta;
        if (!(drop > 0.0) || !(sine < 1.0) || !(height > 0.0)) return seeds;
        seeds.push_back(sine * along - std::sqrt(1.0 - sine * sine) * up);
        return seeds;
    }
    const double depth = drop - height;
    if (!(height > 0.0) || !(depth > 0.0)) return seeds;
    // Distance of the crossing of the plane from the foot of the normal: eta sin 1 - sin 2
    // increases with it.
    const auto miss = [&](double x) {
        return eta * x / std::hypot(x, height) - (across - x) / std::hypot(across - x, depth);
    };
    const double x = across > 0.0 ? bisected(miss, 0.0, across) : 0.0;
    seeds.push_back(normalize(x * along - height * up));
    return seeds;
}

}  // namespace alhazen
