#pragma once
/// In which directions lights send photons that are to meet mirrors and glass.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 3 (projection maps);
/// Hesterberg, "Weighted Average Importance Sampling and Defensive Mixture Distributions",
/// Technometrics 37(2), 1995.
/// Differs: cells of the sphere of directions are marked by rays that are tried, not by projected
/// bounds, with their neighbours. Most are tried beside what was hit, so that no cell at the border
/// is missed: the rare photon of such a cell would be hundreds of times as bright as the others.
/// The density of a cell follows the share of its trials that hit, by little. What is not marked
/// keeps a fifth of the photons, and each photon counts by its density: no light is lost where the
/// trials missed something. Light without a place (the sun, the surroundings) is not aimed, and
/// keeps its share of the photons.
/// Conventions: one map for each of 16 or 64 parts of the choice of a light, or for the only light;
/// world directions. Depends on the scene and the seed alone. Threads: const functions may be
/// called from many.

#include <cstdint>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

class ProjectionMap {
  public:
    /// Casts some hundred thousand rays, with the threads of the caller's ThreadLimit.
    ProjectionMap(const RenderJob& job, const Illumination& lights, std::uint64_t seed,
                  RayCounters& counters);

    /// Illumination::emit, aimed. All numbers in [0, 1).
    [[nodiscard]] LightRay emit(double choice, const Vec2& place, const Vec2& direction,
                                const Wavelengths& waves) const;

    /// Cells from which mirrors or glass may be met; 0: all are alike.
    [[nodiscard]] std::size_t marked() const { return marked_; }
    [[nodiscard]] std::size_t cells() const { return strata_ * side_ * side_; }

  private:
    /// Rays of a cell, and those that met mirrors or glass.
    struct Tally {
        std::uint32_t trials = 0, hits = 0;
    };
    /// A ray of a cell; `share`: the density of the cell over that of even cells.
    [[nodiscard]] LightRay emit_in(std::size_t cell, double share, double choice, const Vec2& place,
                                   const Vec2& direction, const Wavelengths& waves) const;
    [[nodiscard]] bool is_afar(std::size_t stratum) const;
    /// [stratum] The first of those that have its light alone, or itself.
    [[nodiscard]] std::vector<std::size_t> leaders() const;
    /// Adds `trials` of each cell that is `asked` to the tallies: [cell].
    void try_cells(const RenderJob& job, const std::vector<std::size_t>& asked,
                   std::uint32_t trials, std::uint64_t seed, std::vector<Tally>& tallies,
                   RayCounters& counters) const;
    /// What one stratum of a light finds is true of all that have this light alone: sums, at their
    /// leaders.
    [[nodiscard]] std::vector<Tally> shared(const std::vector<Tally>& own,
                                            const std::vector<std::size_t>& leader) const;
    /// [cell] 0: not hit.
    [[nodiscard]] std::vector<float> tried(const RenderJob& job, const std::vector<bool>& afar,
                                           std::uint64_t seed, RayCounters& counters) const;
    [[nodiscard]] std::vector<float> widened(const std::vector<float>& weights) const;
    /// Calls visit(cell) of those around in the same map, and of the cell.
    template <class Visit>
    void for_neighbors(std::size_t cell, const Visit& visit) const;

    const Illumination& lights_;
    std::size_t strata_ = 1;  ///< of the choice
    std::size_t side_ = 1;    ///< cells of a map in latitude, and around the z axis
    std::size_t marked_ = 0;
    std::vector<double> sums_;  ///< [cell] probability of all up to and with it; empty: none marked
};

}  // namespace alhazen
