#pragma once
/// Where lights send photons that are to meet mirrors and glass.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 3 (projection maps);
/// Hesterberg, "Weighted Average Importance Sampling and Defensive Mixture Distributions",
/// Technometrics 37(2), 1995.
/// Differs: cells are marked by rays that are tried, not by projected bounds, and lie in the unit
/// square from which directions are drawn, of light without a place in that of its disc. What is
/// not marked keeps a tenth of the photons, and each counts by its density: no light is lost where
/// the trials missed something.
/// Conventions: depends on the scene and the seed alone. Threads: const functions may be called
/// from many.

#include <cstdint>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

class ProjectionMap {
  public:
    /// Casts some ten thousand rays, with the threads of the caller's ThreadLimit.
    ProjectionMap(const RenderJob& job, const Illumination& lights, std::uint64_t seed,
                  RayCounters& counters);

    /// Arguments of Illumination::emit, and the factor of the light that they give.
    struct Aim {
        double choice = 0;
        Vec2 place, direction;
        double weight = 1;
    };
    /// All in [0, 1).
    [[nodiscard]] Aim aim(double choice, const Vec2& place, const Vec2& direction) const;

    /// Cells from which mirrors or glass may be met; 0: all are alike.
    [[nodiscard]] std::size_t marked() const { return marked_; }
    [[nodiscard]] std::size_t cells() const { return strata_ * side_ * side_; }

  private:
    /// Arguments within a cell.
    [[nodiscard]] Aim within(std::size_t cell, double choice, const Vec2& place,
                             const Vec2& direction) const;
    void widen(std::vector<std::uint8_t>& marks) const;

    std::size_t strata_ = 1;          ///< of the choice of a light
    std::size_t side_ = 1;            ///< cells of a stratum along each side of the square
    std::vector<std::uint8_t> afar_;  ///< [stratum] its light has no place
    std::vector<double> sums_;        ///< [cell] probability of all up to and with it
    std::size_t marked_ = 0;
};

}  // namespace alhazen
