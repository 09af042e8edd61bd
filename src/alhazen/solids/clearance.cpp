#include "alhazen/solids/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/sampling/random.h"
#include "alhazen/solids/line_through_sphere.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kSurfaceLines = 1024;  ///< per solid, for starting points
constexpr std::size_t kStarts = 24;            ///< pairs of points that the search improves
constexpr int kRounds = 60;
constexpr std::size_t kTurns = 8;

using SurfacePoint = IsolatedSolid::SurfacePoint;

/// Points on the surface, from lines in all directions.
std::vector<SurfacePoint> surface_points(const IsolatedSolid& solid, std::uint64_t key) {
    const Box3 box = solid.box();
    const double radius = 0.5 * length(box.size());
    std::vector<SurfacePoint> points;
    for (std::uint32_t i = 0; i < kSurfaceLines; ++i) {
        solid.crossings(line_through_sphere(key, i, box.center(), radius), points);
    }
    return points;
}

struct Pair {
    SurfacePoint a, b;
    double distance = kInfinity;
};

/// The narrowest gap on a line between an end of a span in one solid and an end in the other.
class LineGap {
  public:
    LineGap(const IsolatedSolid& a, const IsolatedSolid& b) : a_(a), b_(b) {}

    /// The gap on a line. Negative `distance`: a point of the line lies in both solids.
    Pair on(const Vec3& through, const Vec3& direction) {
        const Ray line{through, direction, -kInfinity, kInfinity};
        in_a_.clear();
        in_b_.clear();
        Pair best;
        a_.crossings(line, in_a_);
        if (in_a_.empty() || in_a_.size() % 2 != 0) return best;
        b_.crossings(line, in_b_);
        if (in_b_.size() % 2 != 0) return best;
        for (std::size_t i = 0; i < in_a_.size(); i += 2) {
            for (std::size_t k = 0; k < in_b_.size(); k += 2) compare(i, k, best);
        }
        return best;
    }

  private:
    void compare(std::size_t i, std::size_t k, Pair& best) const {
        const SurfacePoint &a0 = in_a_[i], &a1 = in_a_[i + 1];
        const SurfacePoint &b0 = in_b_[k], &b1 = in_b_[k + 1];
        if (a0.t == a1.t || b0.t == b1.t) return;
        if (std::max(a0.t, b0.t) < std::min(a1.t, b1.t)) {
            const SurfacePoint& inside = a0.t > b0.t ? a0 : b0;
            if (best.distance > -1) best = {inside, inside, -1};
            return;
        }
        const bool a_first = a1.t <= b0.t;
        const SurfacePoint& a = a_first ? a1 : a0;
        const SurfacePoint& b = a_first ? b0 : b1;
        const double distance = length(a.point - b.point);
        if (distance < best.distance) best = {a, b, distance};
    }

    const IsolatedSolid& a_;
    const IsolatedSolid& b_;
    std::vector<SurfacePoint> in_a_, in_b_;
};

/// Moves the line through two points in shrinking steps as long as the gap narrows.
Pair improve(LineGap& gap, Pair best, double size) {
    double step = 0.1 * size;
    int turn = 0;
    for (int round = 0; round < kRounds && best.distance > 0; ++round) {
        const Vec3 d = unit_or(best.b.point - best.a.point, best.a.normal);
        const Vec3 right = perpendicular(d);
        const Vec3 up = cross(d, right);
        bool better = false;
        const auto attempt = [&](const Vec3& move_a, const Vec3& move_b) {
            const Vec3 from = best.a.point + move_a;
            const Vec3 to = best.b.point + move_b;
            const Vec3 direction = unit_or(to - from, d);
            const Pair found = gap.on(from, direction);
            if (found.distance < best.distance) {
                best = found;
                better = true;
            }
        };
        // Along the normals: finds the nearest points of flat faces in one step.
        attempt({}, length(best.b.point - best.a.point) * (best.a.normal - d));
        attempt(length(best.b.point - best.a.point) * (best.b.normal + d), {});
        for (std::size_t i = 0; i < kTurns && best.distance > 0; ++i) {
            const double angle = 2 * kPi * (static_cast<double>(i) + 0.37 * turn) / kTurns;
            const Vec3 aside = step * (std::cos(angle) * right + std::sin(angle) * up);
            attempt(aside, {});
            attempt({}, aside);
            attempt(aside, aside);
        }
        ++turn;
        step *= better ? 1.2 : 0.4;
    }
    return best;
}

/// Separating slabs of two solids by direction. The width along n is b's least extent minus a's
/// largest. Times |n| it is concave in n: it is the negated support function of the Minkowski
/// difference of the two hulls.
class SlabSearch {
  public:
    SlabSearch(const IsolatedSolid& a, const IsolatedSolid& b) : a_(a), b_(b) {}

    /// Searches for the widest slab from a start direction; `found` also receives slabs along the
    /// axes.
    void run(const Vec3& start, Clearance& found) {
        best_normal_ = start;
        best_ = width(start);
        for (int k = 0; k < 3; ++k) {
            for (const double side : {-1.0, 1.0}) {
                Vec3 axis;
                axis[k] = side;
                offer(axis);
            }
        }
        tilt();
        // Where edges face each other the width has a ridge, which small turns do not follow.
        for (double half = 0.25; half > 1e-9 && best_ > 0; half *= 0.05) climb_ridges(half);
        if (!(best_ > 0)) return;
        // The computed normal is unit within rounding.
        found.at_least = best_ * (1 - 1e-15);
    }

  private:
    static constexpr int kTilts = 24;
    static constexpr int kSections = 32;  ///< golden-section steps per interval

    [[nodiscard]] double width(const Vec3& n) const { return b_.extent(n).lo - a_.extent(n).hi; }

    double offer(const Vec3& n) {
        const double w = width(n);
        if (w > best_) {
            best_ = w;
            best_normal_ = n;
        }
        return w;
    }

    /// Applies small turns in all directions as long as they widen the slab.
    void tilt() {
        int turn = 0;
        for (double step = 0.2; step > 1e-4;) {
            const Vec3 n = best_normal_, right = perpendicular(n), up = cross(n, right);
            const double before = best_;
            for (int i = 0; i < kTilts && best_ == before; ++i) {
                const double angle = 2.39996322972865332 * ++turn;  // the golden angle
                offer(normalize(n + step * (std::cos(angle) * right + std::sin(angle) * up)));
            }
            if (!(best_ > before + 1e-9 * std::abs(before))) step *= 0.5;
        }
    }

    /// Searches the directions n + x right + y up, |x| and |y| <= `half`. Where the width is
    /// positive it has one maximum over y for each x, and these maxima have one maximum over x.
    void climb_ridges(double half) {
        const Vec3 n = best_normal_, right = perpendicular(n), up = cross(n, right);
        (void)golden_section(half, [&](double x) {
            return golden_section(
                half, [&](double y) { return offer(normalize(n + x * right + y * up)); });
        });
    }

    /// The largest value on [-half, half] of f, which has one maximum. Source: Kiefer, "Sequential
    /// minimax search for a maximum", Proc. AMS 4, 1953.
    template <class F>
    static double golden_section(double half, F f) {
        constexpr double kGolden = 0.61803398874989485;
        double lo = -half, hi = half;
        double x0 = hi - kGolden * (hi - lo), x1 = lo + kGolden * (hi - lo);
        double f0 = f(x0), f1 = f(x1);
        for (int i = 0; i < kSections; ++i) {
            if (f0 > f1) {
                hi = x1;
                x1 = x0;
                f1 = f0;
                x0 = hi - kGolden * (hi - lo);
                f0 = f(x0);
            } else {
                lo = x0;
                x0 = x1;
                f0 = f1;
                x1 = lo + kGolden * (hi - lo);
                f1 = f(x1);
            }
        }
        return std::max(f0, f1);
    }

    const IsolatedSolid& a_;
    const IsolatedSolid& b_;
    double best_ = 0;
    Vec3 best_normal_;
};

/// The nearest pairs between two sets of points.
std::vector<Pair> nearest_pairs(const std::vector<SurfacePoint>& on_a,
                                const std::vector<SurfacePoint>& on_b) {
    std::vector<Pair> nearest;
    for (const SurfacePoint& a : on_a) {
        Pair best;
        for (const SurfacePoint& b : on_b) {
            const double distance = length(a.point - b.point);
            if (distance < best.distance) best = {a, b, distance};
        }
        nearest.push_back(best);
    }
    const std::size_t kept = std::min(kStarts, nearest.size());
    std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(kept),
                      nearest.end(),
                      [](const Pair& x, const Pair& y) { return x.distance < y.distance; });
    nearest.resize(kept);
    return nearest;
}

}  // namespace

Clearance clearance(const IsolatedSolid& a, const IsolatedSolid& b, std::uint64_t seed) {
    if (a.box().empty() || b.box().empty()) {
        throw Error(ErrorKind::Usage, "a solid is empty: there is no clearance");
    }
    if (!a.box().bounded() || !b.box().bounded()) {
        throw Error(ErrorKind::Usage, "a solid is not bounded: clearance requires bounded solids");
    }
    const auto on_a = surface_points(a, mix64(seed));
    const auto on_b = surface_points(b, mix64(seed + 1));
    if (on_a.empty() || on_b.empty()) {
        throw Error(ErrorKind::Usage,
                    "no line met a solid: it is empty or too thin for a clearance");
    }
    LineGap gap(a, b);
    Pair best;
    // Lines between the solids also detect overlap.
    for (std::size_t i = 0; i < std::min(on_a.size(), on_b.size()); ++i) {
        const Vec3 d = unit_or(on_b[i].point - on_a[i].point, on_a[i].normal);
        const Pair found = gap.on(on_a[i].point, d);
        if (found.distance < best.distance) best = found;
    }
    const double size = std::min(length(a.box().size()), length(b.box().size()));
    if (best.distance >= 0) {
        std::vector<Pair> starts = nearest_pairs(on_a, on_b);
        starts.push_back(best);
        for (const Pair& start : starts) {
            const Pair found = improve(gap, start, size);
            if (found.distance < best.distance) best = found;
            if (best.distance < 0) break;
        }
    }
    Clearance found;
    found.on_a = best.a.point;
    found.on_b = best.b.point;
    found.error = std::max(length(best.a.error), length(best.b.error));
    if (best.distance < 0) {
        found.overlap = true;
        return found;
    }
    found.at_most = best.distance;
    SlabSearch(a, b).run(unit_or(best.b.point - best.a.point, best.a.normal), found);
    return found;
}

}  // namespace alhazen
