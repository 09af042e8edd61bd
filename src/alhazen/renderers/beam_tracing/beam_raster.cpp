#include "alhazen/renderers/beam_tracing/beam_raster.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

void add_points(const PolygonSet& region, int j, double y, int first, std::span<const double> xs,
                std::vector<double>& crossings, std::vector<BeamSample>& samples) {
    crossings.clear();
    for (std::size_t l = 0; l < region.loop_count(); ++l) {
        const std::span<const LatticePoint> loop = region.loop(l);
        for (std::size_t k = 0; k < loop.size(); ++k) {
            LatticePoint a = loop[k], b = loop[k + 1 == loop.size() ? 0 : k + 1];
            if (b.y < a.y) std::swap(a, b);
            if (!(a.y <= y) || !(y < b.y)) continue;
            crossings.push_back(a.x + (y - a.y) / (double(b.y) - a.y) * (double(b.x) - a.x));
        }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
        auto at = std::lower_bound(xs.begin(), xs.end(), crossings[k]);
        for (; at != xs.end() && *at < crossings[k + 1]; ++at) {
            samples.push_back({first + static_cast<int>(at - xs.begin()), j, 1.0, {*at, y}});
        }
    }
}

namespace {

/// Limits lattice coordinates to 52 bits, which doubles represent exactly.
constexpr int kHeightBits = 28;

}  // namespace

void RowAreas::Heights::add(double lo, double hi, double sign) {
    const Int128 a = std::llround(std::ldexp(lo, kHeightBits));
    const Int128 b = std::llround(std::ldexp(hi, kHeightBits));
    height += static_cast<std::int64_t>(sign > 0.0 ? b - a : a - b);
    square += sign > 0.0 ? b * b - a * a : a * a - b * b;
}

void RowAreas::begin(double lo, double hi, std::span<const double> edges) {
    lo_ = lo;
    hi_ = hi;
    edges_ = edges;
    own_.assign(edges.size() - 1, {});
    full_.assign(edges.size(), {});
}

void RowAreas::add(const PolygonSet& region) {
    for (std::size_t l = 0; l < region.loop_count(); ++l) {
        const std::span<const LatticePoint> loop = region.loop(l);
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const LatticePoint a = loop[k], b = loop[k + 1 == loop.size() ? 0 : k + 1];
            add_edge(a.x, a.y, b.x, b.y);
        }
    }
}

/// The inside is on the left: a descending edge has it on its right.
void RowAreas::add_edge(double x0, double y0, double x1, double y1) {
    if (y0 == y1) return;
    double sign = 1.0;
    if (y0 > y1) {
        std::swap(x0, x1);
        std::swap(y0, y1);
    } else {
        sign = -1.0;
    }
    if (y1 <= lo_ || y0 >= hi_) return;
    const double slope = (x1 - x0) / (y1 - y0);
    if (y0 < lo_) {
        x0 += slope * (lo_ - y0);
        y0 = lo_;
    }
    if (y1 > hi_) {
        x1 += slope * (hi_ - y1);
        y1 = hi_;
    }
    // Columns from left to right, whether x rises or falls along the edge.
    const double left = std::min(x0, x1), right = std::max(x0, x1);
    const std::size_t columns = own_.size();
    const auto column_of = [&](double x) {
        const auto at = std::upper_bound(edges_.begin(), edges_.end(), x);
        return static_cast<std::ptrdiff_t>(at - edges_.begin()) - 1;
    };
    const std::ptrdiff_t first = column_of(left), last = column_of(right);
    double y = slope >= 0.0 ? y0 : y1, x = left;
    for (std::ptrdiff_t c = first; c <= last; ++c) {
        const double end = c == last ? right : edges_[static_cast<std::size_t>(c + 1)];
        const double y_end = c == last      ? (slope >= 0.0 ? y1 : y0)
                             : right > left ? std::clamp(y0 + (end - x0) / slope, y0, y1)
                                            : y;
        const double a = std::min(y, y_end), b = std::max(y, y_end);
        const double xa = slope >= 0.0 ? x : end, xb = slope >= 0.0 ? end : x;
        if (c < 0) {
            full_[0].add(a, b, sign);
        } else if (static_cast<std::size_t>(c) < columns) {
            add_within(static_cast<std::size_t>(c), xa, a, xb, b, sign);
        }
        y = y_end;
        x = end;
    }
}

void RowAreas::add_within(std::size_t column, double x0, double y0, double x1, double y1,
                          double sign) {
    const double right = edges_[column + 1], h = y1 - y0;
    if (!(h > 0.0)) return;
    const double w0 = right - x0, w1 = right - x1;
    Moments& m = own_[column];
    m.area += sign * h * 0.5 * (w0 + w1);
    // Products of two linear functions, by Simpson's rule, which is exact.
    const double xm = 0.5 * (x0 + x1), ym = 0.5 * (y0 + y1), wm = 0.5 * (w0 + w1);
    const auto half_square = [&](double x) { return 0.5 * (right * right - x * x); };
    m.x += sign * h / 6.0 * (half_square(x0) + 4.0 * half_square(xm) + half_square(x1));
    m.y += sign * h / 6.0 * (y0 * w0 + 4.0 * ym * wm + y1 * w1);
    full_[column + 1].add(y0, y1, sign);
}

void RowAreas::take(int j, int first, std::vector<BeamSample>& samples) {
    Heights sum;
    for (std::size_t c = 0; c < own_.size(); ++c) {
        sum.height += full_[c].height;
        sum.square += full_[c].square;
        const double height = std::ldexp(static_cast<double>(sum.height), -kHeightBits);
        const double of_y = std::ldexp(static_cast<double>(sum.square), -2 * kHeightBits - 1);
        const double left = edges_[c], right = edges_[c + 1], wide = right - left;
        const double pixel = wide * (hi_ - lo_);
        Moments m = own_[c];
        m.area += height * wide;
        m.x += height * 0.5 * (right * right - left * left);
        m.y += of_y * wide;
        if (!(m.area > 1e-12 * pixel)) continue;
        const Vec2 middle{std::clamp(m.x / m.area, left, right),
                          std::clamp(m.y / m.area, lo_, hi_)};
        samples.push_back({first + static_cast<int>(c), j, m.area / pixel, middle});
    }
}

}  // namespace alhazen
