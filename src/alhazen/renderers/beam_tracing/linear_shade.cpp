#include "alhazen/renderers/beam_tracing/linear_shade.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

double largest(const Rgb& a, const Rgb& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// Direction of the steepest ascent of the sum of the channels; (0, 0) if the points are collinear
/// or the sum is constant.
Vec2 direction_of(std::span<const ShadePoint> points, const Vec2& middle, const Rgb& mean) {
    double xx = 0, xy = 0, yy = 0, xs = 0, ys = 0;
    for (const ShadePoint& p : points) {
        const Vec2 d = p.at - middle;
        const Rgb rise = p.color - mean;
        const double s = rise.r + rise.g + rise.b;
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
        xs += d.x * s;
        ys += d.y * s;
    }
    // A small multiple of the identity avoids a division by zero for thin regions.
    const double more = 1e-9 * (xx + yy);
    xx += more;
    yy += more;
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0.0)) return {};
    const Vec2 g{(yy * xs - xy * ys) / determinant, (xx * ys - xy * xs) / determinant};
    const double size = std::hypot(g.x, g.y);
    return size > 0.0 ? Vec2{g.x / size, g.y / size} : Vec2{};
}

}  // namespace

LinearShade fit_shade(std::span<const ShadePoint> points, double enough) {
    LinearShade shade;
    if (points.empty()) return shade;
    const double share = 1.0 / static_cast<double>(points.size());
    Vec2 middle;
    for (const ShadePoint& p : points) {
        shade.mean += share * p.color;
        middle = middle + share * p.at;
    }
    for (const ShadePoint& p : points)
        shade.error = std::max(shade.error, largest(p.color, shade.mean));
    if (shade.error <= enough) return shade;
    const Vec2 along = direction_of(points, middle, shade.mean);
    if (along.x == 0.0 && along.y == 0.0) return shade;
    double tt = 0, lo = 0, hi = 0;
    Rgb slope;
    for (const ShadePoint& p : points) {
        const double t = (p.at.x - middle.x) * along.x + (p.at.y - middle.y) * along.y;
        tt += t * t;
        slope += t * (p.color - shade.mean);
        lo = std::min(lo, t);
        hi = std::max(hi, t);
    }
    if (!(tt > 0.0)) return shade;
    slope = (1.0 / tt) * slope;
    double error = 0;
    for (const ShadePoint& p : points) {
        const double t = (p.at.x - middle.x) * along.x + (p.at.y - middle.y) * along.y;
        error = std::max(error, largest(p.color, shade.mean + t * slope));
    }
    if (error >= shade.error) return shade;
    shade.error = error;
    shade.gradient = DrawingGradient{middle + lo * along, middle + hi * along,
                                     shade.mean + lo * slope, shade.mean + hi * slope};
    return shade;
}

}  // namespace alhazen
