#pragma once
/// Directions in which lights emit photons that are to hit mirrors and glass.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 3 (projection maps);
/// Hesterberg, "Weighted Average Importance Sampling and Defensive Mixture Distributions",
/// Technometrics 37(2), 1995.
/// Differs: cells of the sphere of directions are marked, with their neighbours, by trial rays, not
/// by projected bounds. Most trials are made next to hits, so that no cell at the border is missed:
/// a rare photon of such a cell would be hundreds of times as bright as the others. The density of
/// a cell depends weakly on the share of its trials that hit. Unmarked cells keep a fifth of the
/// photons, and each photon is weighted by its density: no light is lost where trials missed
/// something. Infinitely distant lights (sun, environment) are not restricted, and keep their share
/// of the photons.
/// Conventions: one map for each of 16 or 64 strata of the choice of a light, or for the only
/// light; world directions. Depends only on the scene and the seed. Threads: const functions may be
/// called concurrently.

#include <cstdint>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

class ProjectionMap {
  public:
    /// Traces some hundred thousand rays, with the threads of the caller's ThreadLimit.
    ProjectionMap(const RenderJob& job, const Illumination& lights, std::uint64_t seed,
                  RayCounters& counters);

    /// Illumination::emit with restricted directions. All numbers in [0, 1).
    [[nodiscard]] LightRay emit(double choice, const Vec2& place, const Vec2& direction,
                                const Wavelengths& waves) const;

    /// Number of marked cells; 0: directions are not restricted.
    [[nodiscard]] std::size_t marked() const { return marked_; }
    [[nodiscard]] std::size_t cells() const { return strata_ * side_ * side_; }

  private:
    /// Number of trials of a cell, and of hits of mirrors or glass.
    struct Tally {
        std::uint32_t trials = 0, hits = 0;
    };
    /// Emits a ray of a cell; `share`: density of the cell relative to uniform cells.
    [[nodiscard]] LightRay emit_in(std::size_t cell, double share, double choice, const Vec2& place,
                                   const Vec2& direction, const Wavelengths& waves) const;
    [[nodiscard]] bool is_afar(std::size_t stratum) const;
    /// [stratum] the first stratum filled by the same light alone; otherwise itself.
    [[nodiscard]] std::vector<std::size_t> leaders() const;
    /// Adds `trials` of each cell in `asked` to the tallies: [cell].
    void try_cells(const RenderJob& job, const std::vector<std::size_t>& asked,
                   std::uint32_t trials, std::uint64_t seed, std::vector<Tally>& tallies,
                   RayCounters& counters) const;
    /// Sums of the tallies over all strata filled by one light alone, at their leaders.
    [[nodiscard]] std::vector<Tally> shared(const std::vector<Tally>& own,
                                            const std::vector<std::size_t>& leader) const;
    /// [cell] weights; 0: no hits.
    [[nodiscard]] std::vector<float> tried(const RenderJob& job, const std::vector<bool>& afar,
                                           std::uint64_t seed, RayCounters& counters) const;
    [[nodiscard]] std::vector<float> widened(const std::vector<float>& weights) const;
    /// Calls visit(cell) for the cell and its neighbours in the same map.
    template <class Visit>
    void for_neighbors(std::size_t cell, const Visit& visit) const;

    const Illumination& lights_;
    std::size_t strata_ = 1;  ///< number of strata of the choice of a light
    std::size_t side_ = 1;    ///< cells of a map along latitude, and around the z axis
    std::size_t marked_ = 0;
    std::vector<double> sums_;  ///< [cell] cumulative probability; empty: none marked
};

}  // namespace alhazen
