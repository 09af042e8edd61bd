#include "alhazen/shapes/swept/profile.h"

#include <algorithm>

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

namespace {

Vec2 blend(Vec2 a, Vec2 b, double s) {
    return {(1.0 - s) * a.x + s * b.x, (1.0 - s) * a.y + s * b.y};
}

double larger(Vec2 v) {
    return std::max(std::abs(v.x), std::abs(v.y));
}

/// Calls f(loop's first curve, one past its last).
template <class F>
void for_each_loop(const Profile& profile, F f) {
    std::size_t begin = 0;
    for (const std::size_t end : profile.loop_ends) {
        f(begin, end);
        begin = end;
    }
}

}  // namespace

Vec2 ProfileCurve::point(double s) const {
    // Interpolates from the nearer end: a coordinate that both ends share stays exact.
    if (line) return s < 0.5 ? p[0] + s * (p[3] - p[0]) : p[3] + (1.0 - s) * (p[0] - p[3]);
    const Vec2 a = blend(p[0], p[1], s), b = blend(p[1], p[2], s), c = blend(p[2], p[3], s);
    return blend(blend(a, b, s), blend(b, c, s), s);
}

Vec2 ProfileCurve::derivative(double s) const {
    if (line) return p[3] - p[0];
    const Vec2 a = p[1] - p[0], b = p[2] - p[1], c = p[3] - p[2];
    return 3.0 * blend(blend(a, b, s), blend(b, c, s), s);
}

Vec2 ProfileCurve::direction(double s) const {
    const Vec2 d = derivative(s);
    if (line) return d;
    const double size = std::max({larger(p[1] - p[0]), larger(p[2] - p[1]), larger(p[3] - p[2])});
    if (larger(d) > 1e-7 * size) return d;
    for (const double step : {1e-3, 1.0}) {
        const Vec2 chord = point(std::min(1.0, s + step)) - point(std::max(0.0, s - step));
        if (larger(chord) > 1e-9 * size) return chord;
    }
    return {size, 0.0};
}

ProfileCurve line_curve(Vec2 from, Vec2 to) {
    return {.p = {from, from, to, to}, .line = true};
}
ProfileCurve cubic_curve(Vec2 from, Vec2 control1, Vec2 control2, Vec2 to) {
    return {.p = {from, control1, control2, to}, .line = false};
}

bool Profile::loops_close() const {
    bool all = true;
    for_each_loop(*this, [&](std::size_t begin, std::size_t end) {
        all = all && begin < end && curves[end - 1].p[3] == curves[begin].p[0];
    });
    return all;
}

std::array<Vec2, 2> Profile::bounds() const {
    std::array<Vec2, 2> box{Vec2{kInfinity, kInfinity}, Vec2{-kInfinity, -kInfinity}};
    for (const ProfileCurve& curve : curves) {
        for (const Vec2& p : curve.p) {
            box[0] = {std::min(box[0].x, p.x), std::min(box[0].y, p.y)};
            box[1] = {std::max(box[1].x, p.x), std::max(box[1].y, p.y)};
        }
    }
    return box;
}

double Profile::reach() const {
    double reach = 0.0;
    for (const ProfileCurve& curve : curves) {
        for (const Vec2& p : curve.p) reach = std::max(reach, larger(p));
    }
    return reach;
}

void Profile::validate(FieldChecks& checks) const {
    if (curves.empty() || loop_ends.empty() || loop_ends.back() != curves.size()) {
        return checks.fail("the profile needs at least one loop of lines or curves");
    }
    for (const ProfileCurve& curve : curves) {
        for (const Vec2& p : curve.p) {
            checks.point("point of the profile", {p.x, p.y, 0.0});
            if (!checks.ok()) return;
        }
    }
    const auto [lo, hi] = bounds();
    if (!(larger(hi - lo) >= kMinLength)) return checks.fail("the profile is a single point");
    bool chained = true;
    for_each_loop(*this, [&](std::size_t begin, std::size_t end) {
        chained = chained && begin < end;
        for (std::size_t i = begin + 1; i < end && chained; ++i) {
            chained = curves[i - 1].p[3] == curves[i].p[0];
        }
    });
    if (!chained) checks.fail("each curve of the profile must begin where the one before ends");
}

}  // namespace alhazen
