#pragma once
/// Precomputed tables of the part of a cone that a sphere or a plane covers.
///
/// Source: Kirk, "The Simulation of Natural Features Using Cone Tracing", The Visual Computer
/// 3(2), 1987 (areas of circles in tables).
/// Differs: the distance of the discs is measured from where they touch internally to where they
/// touch externally, and the radius is R / (1 + R), so that the table has no unused half and covers
/// every radius.
/// Conventions: arguments in units of the cone's radius; results are parts of the cone, 0 to 1.
/// Complexity: four table entries read for a sphere, two for a plane. Error at most 1e-3 (measured:
/// docs/design/cone_tracing.md). Threads: const.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace alhazen {

class CoverageTables {
  public:
    CoverageTables();
    /// The tables, shared by the whole program.
    [[nodiscard]] static const CoverageTables& shared();

    /// The part covered by a disc of radius `R` at distance `d`.
    [[nodiscard]] double sphere(double d, double R) const {
        const double least = std::abs(R - 1.0), most = R + 1.0;
        if (d >= most) return 0.0;
        if (d <= least) return R < 1.0 ? R * R : 1.0;
        const double x = (d - least) / (most - least) * kDistances;
        const double y = R / most * kRadii;
        const auto i = std::min(static_cast<std::size_t>(x), kDistances - 1);
        const auto j = std::min(static_cast<std::size_t>(y), kRadii - 1);
        const double fx = x - static_cast<double>(i), fy = y - static_cast<double>(j);
        const float* p = spheres_.data() + j * (kDistances + 1) + i;
        const auto between = [&](const float* q) {
            const double q0 = q[0];
            return q0 + fx * (q[1] - q0);
        };
        const double low = between(p);
        const double share = low + fy * (between(p + kDistances + 1) - low);
        return R < 1.0 ? share * (R * R) : share;
    }
    /// The part beyond a line at the signed distance `h`.
    [[nodiscard]] double plane(double h) const {
        if (h >= 1.0) return 0.0;
        if (h <= -1.0) return 1.0;
        const double x = 0.5 * (h + 1.0) * kPlanes;
        const auto i = std::min(static_cast<std::size_t>(x), kPlanes - 1);
        return planes_[i] + (x - static_cast<double>(i)) * (planes_[i + 1] - planes_[i]);
    }

  private:
    static constexpr std::size_t kDistances = 96, kRadii = 256, kPlanes = 256;
    std::vector<float> spheres_;  ///< [radius][distance], as a part of the smaller disc
    std::array<double, kPlanes + 1> planes_;
};

}  // namespace alhazen
