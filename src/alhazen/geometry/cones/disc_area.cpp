#include "alhazen/geometry/cones/disc_area.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/math/plane_vectors.h"

namespace alhazen {

namespace {

/// The sector between the directions of two points, on the shorter side.
DiscPart sector(const Vec2& a, const Vec2& b) {
    const double la = std::sqrt(dot_of(a, a)), lb = std::sqrt(dot_of(b, b));
    if (!(la > 0.0 && lb > 0.0)) return {};
    const Vec2 ua = (1.0 / la) * a, ub = (1.0 / lb) * b;
    const double angle = std::atan2(cross_of(ua, ub), dot_of(ua, ub));
    return {0.5 * angle, {(ub.y - ua.y) / 3.0, (ua.x - ub.x) / 3.0}};
}

/// The triangle of two points and the centre.
DiscPart triangle(const Vec2& a, const Vec2& b) {
    const double area = 0.5 * cross_of(a, b);
    return {area, (area / 3.0) * (a + b)};
}

}  // namespace

double segment_area(double r, double h) {
    if (h >= r) return 0.0;
    if (h <= -r) return kPi * r * r;
    return r * r * std::acos(h / r) - h * std::sqrt((r - h) * (r + h));
}

double lens_area(double r, double R, double d) {
    if (d >= r + R) return 0.0;
    if (d <= std::abs(R - r)) return kPi * std::min(r, R) * std::min(r, R);
    const double of_r = std::clamp((d * d + r * r - R * R) / (2.0 * d * r), -1.0, 1.0);
    const double of_R = std::clamp((d * d + R * R - r * r) / (2.0 * d * R), -1.0, 1.0);
    const double product = (-d + r + R) * (d + r - R) * (d - r + R) * (d + r + R);
    return r * r * std::acos(of_r) + R * R * std::acos(of_R) -
           0.5 * std::sqrt(std::max(product, 0.0));
}

DiscPart lens(double R, double d) {
    if (d >= 1.0 + R) return {};
    if (d <= R - 1.0) return {kPi, {0, 0}};
    if (d <= 1.0 - R) return {kPi * R * R, {kPi * R * R * d, 0}};
    // Two segments with a common chord: their moments about their own centres cancel.
    const double chord = (d * d + (1.0 - R) * (1.0 + R)) / (2.0 * d);
    const double other = segment_area(R, d - chord);
    return {segment_area(1.0, chord) + other, {other * d, 0}};
}

DiscPart edge_part(const Vec2& a, const Vec2& b) {
    const Vec2 along = b - a;
    const double aa = dot_of(along, along), half = dot_of(a, along);
    if (!(aa > 0.0)) return {};
    // Solves |a + t along| = 1 by the distance of the line from the centre: corners may be far
    // away.
    const double off = cross_of(a, b);
    const double square = aa - off * off;
    if (!(square > 0.0)) return sector(a, b);
    const double root = std::sqrt(square);
    const double t0 = (-half - root) / aa, t1 = (-half + root) / aa;
    if (t1 <= 0.0 || t0 >= 1.0) return sector(a, b);
    DiscPart part;
    Vec2 p = a, q = b;
    if (t0 > 0.0) {
        p = a + t0 * along;
        part += sector(a, p);
    }
    if (t1 < 1.0) {
        q = a + t1 * along;
        part += sector(q, b);
    }
    part += triangle(p, q);
    return part;
}

DiscPart loop_part(std::span<const Vec2> loop) {
    DiscPart sum;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        sum += edge_part(loop[k], loop[k + 1 == loop.size() ? 0 : k + 1]);
    }
    return sum;
}

}  // namespace alhazen
