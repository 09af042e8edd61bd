#include "alhazen/renderers/beam_tracing/pixel_polygon.h"

#include <algorithm>
#include <array>
#include <limits>

namespace alhazen {

void cut_loop(std::span<const Vec2> loop, int axis, double at, bool above,
              std::vector<Vec2>& result) {
    result.clear();
    double Vec2::*const along = axis == 0 ? &Vec2::x : &Vec2::y;
    const auto side = [&](const Vec2& p) { return above ? p.*along - at : at - p.*along; };
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec2 &a = loop[k], &b = loop[k + 1 == loop.size() ? 0 : k + 1];
        const double of_a = side(a), of_b = side(b);
        if (of_a >= 0.0) result.push_back(a);
        if ((of_a >= 0.0) == (of_b >= 0.0)) continue;
        // Starts from the same end for both regions that share the edge.
        const bool forward = of_a < of_b;
        const Vec2 &p = forward ? a : b, &q = forward ? b : a;
        const double t = (forward ? of_a : of_b) / (forward ? of_a - of_b : of_b - of_a);
        Vec2 met = p + t * (q - p);
        met.*along = at;
        result.push_back(met);
    }
}

PixelPolygon PixelPolygon::within(const Vec2& lo, const Vec2& hi) const {
    PixelPolygon result;
    std::vector<Vec2> one, other;
    for (std::size_t k = 0; k < ends.size(); ++k) {
        cut_loop(loop(k), 0, lo.x, true, one);
        cut_loop(one, 0, hi.x, false, other);
        cut_loop(other, 1, lo.y, true, one);
        cut_loop(one, 1, hi.y, false, other);
        if (other.size() >= 3) result.add(other);
    }
    return result;
}

PixelPolygon whole_pixel() {
    PixelPolygon pixel;
    pixel.add(std::array<Vec2, 4>{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}});
    return pixel;
}

void RowStrip::set(const PolygonSet& region, double lo, double hi) {
    strip_.points.clear();
    strip_.ends.clear();
    lo_ = lo;
    hi_ = hi;
    left_ = std::numeric_limits<double>::infinity();
    right_ = -left_;
    for (std::size_t l = 0; l < region.loop_count(); ++l) {
        one_.clear();
        for (const LatticePoint& p : region.loop(l)) one_.push_back({1.0 * p.x, 1.0 * p.y});
        cut_loop(one_, 1, lo, true, other_);
        cut_loop(other_, 1, hi, false, one_);
        if (one_.size() < 3) continue;
        for (const Vec2& p : one_) {
            left_ = std::min(left_, p.x);
            right_ = std::max(right_, p.x);
        }
        strip_.add(one_);
    }
}

void RowStrip::cut(double left, double right, PixelPolygon& result) {
    result.points.clear();
    result.ends.clear();
    for (std::size_t l = 0; l < strip_.ends.size(); ++l) {
        cut_loop(strip_.loop(l), 0, left, true, one_);
        cut_loop(one_, 0, right, false, other_);
        if (other_.size() < 3) continue;
        for (Vec2& p : other_) {
            p = {(p.x - left) / (right - left) - 0.5, (p.y - lo_) / (hi_ - lo_) - 0.5};
        }
        result.add(other_);
    }
}

}  // namespace alhazen
