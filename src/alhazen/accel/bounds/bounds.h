#pragma once
/// Ray-bound tests: spheres, ellipsoids, boxes, and slab sets.
///
/// Source: Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs shared by all bounds,
/// S and T once per ray); Glassner (ed.), "An Introduction to Ray Tracing", 1989, chapter 6
/// (spheres, ellipsoids and boxes as bounds).
/// Differs: a slab is stored as the range [lo, hi] of n . p (Kay and Kajiya write the planes A x +
/// B y + C z + D = 0), so that t = (D - S) T with S = n . origin, T = 1 / (n . direction). Every
/// test is widened by more than the rounding errors, in double, of itself and of the primitives'
/// tests: a bound only rejects rays that cannot hit.
/// Conventions: a bound is `Bound::of` one primitive and grows by `include`. `enter` returns where
/// a ray enters it, at least ray.t_min; empty if the ray misses it or is past it. `Probe` holds
/// values computed once per ray.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

#include "alhazen/accel/core/traversal_stats.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

/// Relative margin for rounding: far larger than that of a primitive's test, far smaller than the
/// savings of a bound.
inline constexpr double kBoundSlack = 0x1p-40;

/// Unit directions of K slabs: the axes, then the diagonals of the cube, then the diagonals of its
/// faces.
template <int K>
struct SlabDirections {
    static_assert(K == 3 || K == 7 || K == 13);
    static const std::array<Vec3, K>& all() {
        static const std::array<Vec3, K> directions = [] {
            const double a = 1.0 / std::sqrt(3.0);
            const double b = 1.0 / std::sqrt(2.0);
            const std::array<Vec3, 13> most{{{1, 0, 0},
                                             {0, 1, 0},
                                             {0, 0, 1},
                                             {a, a, a},
                                             {-a, a, a},
                                             {a, -a, a},
                                             {-a, -a, a},
                                             {b, b, 0},
                                             {b, -b, 0},
                                             {b, 0, b},
                                             {b, 0, -b},
                                             {0, b, b},
                                             {0, b, -b}}};
            std::array<Vec3, K> some;
            std::copy_n(most.begin(), K, some.begin());
            return some;
        }();
        return directions;
    }
};

/// A bound of K slabs; a box for K = 3.
template <int K>
struct SlabBound {
    std::array<Interval, K> range;

    [[nodiscard]] static SlabBound of(const BoundsSource& source, std::size_t i) {
        SlabBound bound;
        const auto& directions = SlabDirections<K>::all();
        const Box3 box = source.box(i);
        for (int k = 0; k < 3; ++k) bound.range[k] = {box.lo[k], box.hi[k]};
        for (int k = 3; k < K; ++k) bound.range[k] = source.extent(i, directions[k]);
        return bound;
    }
    void include(const SlabBound& b) {
        for (int k = 0; k < K; ++k) range[k] = hull(range[k], b.range[k]);
    }
    /// Half the surface area of the box of the first three slabs.
    [[nodiscard]] double half_area() const {
        const double x = range[0].width(), y = range[1].width(), z = range[2].width();
        return x * y + y * z + z * x;
    }
    [[nodiscard]] double center(int axis) const { return 0.5 * (range[axis].lo + range[axis].hi); }

    /// S and T of every slab. The steepest slab comes first: it is the most likely to reject.
    class Probe {
      public:
        explicit Probe(const Ray& ray) : t_min_(ray.t_min), reach_(max_component(abs(ray.origin))) {
            const auto& directions = SlabDirections<K>::all();
            std::array<double, K> steepness;
            for (int k = 0; k < K; ++k) {
                const double along = dot(directions[k], ray.direction);
                s_[k] = dot(directions[k], ray.origin);
                t_[k] = 1.0 / along;
                steepness[k] = std::abs(along);
                order_[k] = static_cast<std::uint8_t>(k);
            }
            std::stable_sort(order_.begin(), order_.end(),
                             [&](int a, int b) { return steepness[a] > steepness[b]; });
        }

        template <class Stats>
        [[nodiscard]] std::optional<double> enter(const SlabBound& bound, double t_max,
                                                  Stats stats) const {
            stats.boxes(1);
            double near = t_min_;
            double far = t_max;
            for (const int k : order_) {
                stats.slabs(1);
                const Interval& d = bound.range[k];
                const double margin =
                    kBoundSlack * (reach_ + std::max(std::abs(d.lo), std::abs(d.hi)));
                const double to_lo = d.lo - margin - s_[k];
                const double to_hi = d.hi + margin - s_[k];
                if (std::isinf(t_[k])) {
                    if (to_lo > 0.0 || to_hi < 0.0) return std::nullopt;
                    continue;
                }
                const double a = to_lo * t_[k];
                const double b = to_hi * t_[k];
                near = std::max(near, std::min(a, b));
                far = std::min(far, std::max(a, b));
                if (near > far) return std::nullopt;
            }
            return near;
        }

      private:
        std::array<double, K> s_, t_;
        std::array<std::uint8_t, K> order_;
        double t_min_, reach_;
    };
};

using BoxBound = SlabBound<3>;

struct SphereBound {
    Vec3 center;
    double radius = 0;

    [[nodiscard]] static SphereBound of(const BoundsSource& source, std::size_t i) {
        const BoundingSphere sphere = source.sphere(i);
        return {sphere.center, sphere.radius};
    }
    /// Grows to the smallest sphere around both, slightly enlarged.
    void include(const SphereBound& b) {
        const Vec3 between = b.center - center;
        const double distance = length(between);
        if (distance + b.radius <= radius) return;
        if (distance + radius <= b.radius) {
            *this = b;
            return;
        }
        const double grown = 0.5 * (distance + radius + b.radius);
        center = center + ((grown - radius) / distance) * between;
        radius = grown * (1.0 + 1e-14) + 1e-15 * max_component(abs(center));
    }
    /// Half the surface area, for comparisons of costs.
    [[nodiscard]] double half_area() const { return 2.0 * std::numbers::pi * radius * radius; }

    class Probe {
      public:
        explicit Probe(const Ray& ray)
            : ray_(ray),
              unit_(ray.direction / length(ray.direction)),
              per_length_(1.0 / length(ray.direction)),
              reach_(max_component(abs(ray.origin))) {}

        template <class Stats>
        [[nodiscard]] std::optional<double> enter(const SphereBound& bound, double t_max,
                                                  Stats stats) const {
            stats.boxes(1);
            const double margin =
                kBoundSlack * (reach_ + bound.radius + max_component(abs(bound.center)));
            const double grown = bound.radius + margin;
            const Vec3 to_center = bound.center - ray_.origin;
            const double along = dot(to_center, unit_);
            // Measured perpendicular to the ray, to avoid cancellation for distant origins.
            const double across2 = length_squared(to_center - along * unit_);
            if (across2 > grown * grown) return std::nullopt;
            const double half = std::sqrt(grown * grown - across2) + margin;
            const double near = std::max(ray_.t_min, (along - half) * per_length_);
            const double far = std::min(t_max, (along + half) * per_length_);
            if (near > far) return std::nullopt;
            return near;
        }

      private:
        const Ray& ray_;
        Vec3 unit_;
        double per_length_, reach_;
    };
};

/// An ellipsoid with axes along the coordinate axes: the smallest one around the box of a
/// primitive. The test transforms the ray to the ellipsoid's scale.
struct EllipsoidBound {
    Vec3 center, axes;

    [[nodiscard]] static EllipsoidBound of(const BoundsSource& source, std::size_t i) {
        const Box3 box = source.box(i);
        const Vec3 half = 0.5 * box.size();
        const double widest = max_component(half);
        // The ellipsoid of a flat primitive is thin, that of a point tiny.
        const double least = std::max(1e-9 * widest, std::numeric_limits<double>::min());
        EllipsoidBound bound{box.center(), {}};
        for (int k = 0; k < 3; ++k) bound.axes[k] = std::numbers::sqrt3 * std::max(half[k], least);
        return bound;
    }

    class Probe {
      public:
        explicit Probe(const Ray& ray) : ray_(ray), reach_(max_component(abs(ray.origin))) {}

        template <class Stats>
        [[nodiscard]] std::optional<double> enter(const EllipsoidBound& bound, double t_max,
                                                  Stats stats) const {
            stats.boxes(1);
            Vec3 grown = bound.axes;
            const double margin = kBoundSlack * (reach_ + max_component(abs(bound.center)));
            for (int k = 0; k < 3; ++k) grown[k] += margin;
            const Vec3 direction{ray_.direction.x / grown.x, ray_.direction.y / grown.y,
                                 ray_.direction.z / grown.z};
            const Vec3 between = bound.center - ray_.origin;
            const Vec3 to_center{between.x / grown.x, between.y / grown.y, between.z / grown.z};
            const double steps = length(direction);
            const Vec3 unit = direction / steps;
            const double along = dot(to_center, unit);
            const double slack = 1.0 + kBoundSlack * (1.0 + max_component(abs(to_center)));
            const double across2 = length_squared(to_center - along * unit);
            if (across2 > slack * slack) return std::nullopt;
            const double half = std::sqrt(slack * slack - across2) + (slack - 1.0);
            const double near = std::max(ray_.t_min, (along - half) / steps);
            const double far = std::min(t_max, (along + half) / steps);
            if (near > far) return std::nullopt;
            return near;
        }

      private:
        const Ray& ray_;
        double reach_;
    };
};

}  // namespace alhazen
