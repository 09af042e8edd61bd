#include "alhazen/renderers/beam_tracing/pixel_quadrature.h"

namespace alhazen {

namespace {

Vec2 within_pixel(const Vec2& p) {
    return {std::clamp(p.x, -0.5, 0.5), std::clamp(p.y, -0.5, 0.5)};
}

/// Integrals of 1, x, y, x^2, xy, y^2, by triangles to the origin.
struct PlaneMoments {
    double area = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    void add(const Vec2& a, const Vec2& b) {
        const double cross = a.x * b.y - b.x * a.y;
        area += cross / 2.0;
        x += cross * (a.x + b.x) / 6.0;
        y += cross * (a.y + b.y) / 6.0;
        xx += cross * (a.x * a.x + a.x * b.x + b.x * b.x) / 12.0;
        xy += cross * (a.x * (2.0 * a.y + b.y) + b.x * (a.y + 2.0 * b.y)) / 24.0;
        yy += cross * (a.y * a.y + a.y * b.y + b.y * b.y) / 12.0;
    }
};

}  // namespace

PixelRule rule_of(const PixelPolygon& polygon) {
    PixelRule rule;
    if (polygon.points.empty()) return rule;
    // Relative to a corner, so that small areas lose no digits.
    const Vec2 from = polygon.points[0];
    rule.lo = rule.hi = from;
    PlaneMoments m;
    for (std::size_t l = 0; l < polygon.ends.size(); ++l) {
        const std::span<const Vec2> loop = polygon.loop(l);
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Vec2& p = loop[k];
            m.add(p - from, loop[k + 1 == loop.size() ? 0 : k + 1] - from);
            rule.lo = {std::min(rule.lo.x, p.x), std::min(rule.lo.y, p.y)};
            rule.hi = {std::max(rule.hi.x, p.x), std::max(rule.hi.y, p.y)};
        }
    }
    rule.area = m.area;
    if (!(m.area > 0.0)) {
        rule.middle = rule.points[0] = rule.points[1] = rule.points[2] = rule.points[3] =
            within_pixel(0.5 * (rule.lo + rule.hi));
        return rule;
    }
    const Vec2 mean{m.x / m.area, m.y / m.area};
    rule.middle = within_pixel(from + mean);
    const double xx = std::max(0.0, m.xx / m.area - mean.x * mean.x);
    const double yy = std::max(0.0, m.yy / m.area - mean.y * mean.y);
    const double xy = m.xy / m.area - mean.x * mean.y;
    const double half = 0.5 * (xx + yy), apart = std::hypot(0.5 * (xx - yy), xy);
    // A square has no principal direction: the axes are used.
    const double angle = apart > 1e-9 * half ? 0.5 * std::atan2(2.0 * xy, xx - yy) : 0.0;
    const Vec2 along{std::cos(angle), std::sin(angle)}, across{-along.y, along.x};
    const Vec2 u = std::sqrt(2.0 * (half + apart)) * along;
    const Vec2 v = std::sqrt(2.0 * std::max(0.0, half - apart)) * across;
    rule.points = {within_pixel(rule.middle - u), within_pixel(rule.middle + u),
                   within_pixel(rule.middle - v), within_pixel(rule.middle + v)};
    return rule;
}

}  // namespace alhazen
