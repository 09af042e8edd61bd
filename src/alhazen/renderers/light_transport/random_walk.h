#pragma once
/// Subpaths, one ray after the other: from the eye, or from a light, through volumes that scatter.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapters 8 and
/// 10.
/// Conventions: densities are those of path_vertex.h. Singular directions count as of density 1 by
/// solid angle on both sides: every way to find a path has them. Surfaces that a path passes
/// straight (coverage, thin sheets) are no vertices.

#include <cstdint>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/light_transport/path_chance.h"
#include "alhazen/renderers/light_transport/path_vertex.h"
#include "alhazen/renderers/light_transport/scattering_media.h"

namespace alhazen {

/// The beginning of a walk.
struct WalkStart {
    Ray ray;
    Spectrum throughput{1, 1, 1, 1};
    const Wavelengths* waves = &kColorChannels;  ///< of the path as it begins
    /// By solid angle; by area across the ray where it is parallel; 0: singular.
    double density = 0;
    bool parallel = false;
    float time = 0;
    MediumStack media;  ///< around it
};

/// Numbers and limits of a walk.
struct WalkLuck {
    const PathChance& chance;
    const SampleId& id;
    std::uint32_t first_pair;  ///< of the first bounce; kWalkPairs for each
    int most;                  ///< vertices
    int roulette;              ///< vertices after which it may end by chance
};
inline constexpr std::uint32_t kWalkPairs = 3;

class RandomWalk {
  public:
    RandomWalk(const Scene& scene, const Illumination& lights, RayCounters& counters,
               TraversalStats* stats)
        : scene_(scene),
          lights_(lights),
          counters_(counters),
          stats_(stats),
          scattering_(scene),
          constant_(scene),
          bsdfs_(scene),
          faces_(scene) {}

    /// Sets `vertices`. A path from the eye that leaves the scene sets `escaped`; its direction and
    /// density by solid angle are those of the last ray.
    void walk(Transport transport, const WalkStart& start, const WalkLuck& luck,
              std::vector<PathVertex>& vertices);

    struct Escape {
        bool is = false;
        Vec3 direction;
        Spectrum throughput;
        double density = 0;   ///< 1: singular
        double backward = 1;  ///< as of PathVertex
    };
    [[nodiscard]] const Escape& escape() const { return escape_; }

  private:
    /// The end of a walk so far.
    struct Front {
        Ray ray;
        Wavelengths waves;
        Spectrum throughput;
        double density = 0;
        bool parallel = false;
        MediumStack media;
    };
    enum class Meets : std::uint8_t { Nothing, Surface, Volume };
    enum class Step : std::uint8_t { Ends, Straight, Scattered };

    /// What it stops at next: a surface, or a point in a volume where the ray then begins.
    [[nodiscard]] Meets find(Front& front, const WalkLuck& luck, const WalkStart& start);
    /// A medium that does not scatter takes its share of a stretch.
    void absorb(Front& front, double length) const;
    /// Goes into or out of a volume where the surface does not cover.
    void pass_opening(Front& front);
    /// Whether a stretch of that length in a medium that scatters does, before its end.
    [[nodiscard]] bool scatters_within(Front& front, const Medium& medium,
                                       const VolumeScattering& scattering, double length,
                                       const WalkLuck& luck, const WalkStart& start);
    /// The last vertex, and the one before; null: the first has none.
    struct Ends {
        PathVertex& v;
        PathVertex* before;
        bool last;  ///< of as many as the walk may have
    };
    /// All but what the vertex does with light. Inlined, as what follows: light_tracing takes half
    /// a per cent fewer instructions.
    [[gnu::always_inline]] inline void set_vertex(const Front& front, const WalkStart& start,
                                                  Meets meets, const Ends& ends);
    void set_emission(const Front& front, const Ends& ends) const;
    /// Sets that, and goes on from there.
    [[nodiscard, gnu::always_inline]] inline Step scatter_at_surface(Transport transport,
                                                                     Front& front,
                                                                     const WalkLuck& luck,
                                                                     std::uint32_t pair,
                                                                     const Ends& ends);
    [[nodiscard]] Step scatter_in_volume(Front& front, const WalkLuck& luck, std::uint32_t pair,
                                         const Ends& ends);

    const Scene& scene_;
    const Illumination& lights_;
    RayCounters& counters_;
    TraversalStats* stats_;
    ScatteringMedia scattering_;
    MaterialCache constant_;
    BsdfCache bsdfs_;
    ShadingPoint point_;
    CoincidentFaces faces_;  ///< at the point
    ScatterPoint opening_;   ///< a surface that is passed where it does not cover
    Hit hit_;
    double travelled_ = 0;  ///< since the last vertex
    double segment_ = 0;    ///< of it in the ray at hand
    std::uint32_t met_ = 0;
    std::uint32_t stretch_ = 0;  ///< stretches through what scatters
    FreeFlight flight_;          ///< since the last vertex
    double eta_scale_ = 1;
    RayKind kind_ = RayKind::Eye;
    Escape escape_;
};

}  // namespace alhazen
