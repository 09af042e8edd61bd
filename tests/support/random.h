#pragma once
/// Random numbers for tests: the same on every machine, from a seed that the test prints when it
/// fails.

#include <cstdint>
#include <random>

#include "alhazen/geometry/ray.h"

namespace alhazen::testing {

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// In [0, 1). Not std::uniform_real_distribution, whose numbers differ between libraries.
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
    double log_uniform(double lo, double hi) { return lo * std::pow(hi / lo, uniform()); }
    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
    bool coin() { return below(2) == 0; }
    double sign() { return coin() ? 1.0 : -1.0; }

    Vec3 in_cube(double half) {
        const double x = uniform(-half, half);
        const double y = uniform(-half, half);
        return {x, y, uniform(-half, half)};
    }
    Vec3 unit_vector() {
        for (;;) {
            const Vec3 v = in_cube(1.0);
            const double squared = length_squared(v);
            if (squared > 0.01 && squared <= 1.0) return normalize(v);
        }
    }
    /// A point whose coordinates are multiples of `step` in [-half, half].
    Vec3 on_lattice(double half, double step) {
        const int n = static_cast<int>(half / step);
        const double x = step * (below(2 * n + 1) - n);
        const double y = step * (below(2 * n + 1) - n);
        return {x, y, step * (below(2 * n + 1) - n)};
    }
    /// A nonzero direction with components -1, -0.0, 0.0 or 1, mostly along one axis.
    Vec3 lattice_direction() {
        constexpr double kChoices[] = {-1.0, -0.0, 0.0, 1.0};
        for (;;) {
            Vec3 d{kChoices[below(4)], kChoices[below(4)], kChoices[below(4)]};
            if (coin()) d[below(3)] = coin() ? 0.0 : -0.0;
            if (coin()) d[below(3)] = coin() ? 0.0 : -0.0;
            if (d != Vec3{}) return d;
        }
    }

  private:
    std::mt19937_64 engine_;
};

/// A ray with an infinite range in both directions.
inline Ray line(const Vec3& origin, const Vec3& direction) {
    const double inf = std::numeric_limits<double>::infinity();
    return {origin, direction, -inf, inf};
}

}  // namespace alhazen::testing
