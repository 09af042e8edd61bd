#pragma once
/// Subpaths, one ray after the other: from the eye, or from a light.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapters 8 and
/// 10.
/// Conventions: densities of vertices are by area. Singular directions count as of density 1 by
/// solid angle on both sides: every way to find a path has them. Surfaces that a path passes
/// straight (coverage, thin sheets) are no vertices.

#include <cstdint>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/light_transport/path_chance.h"
#include "alhazen/renderers/light_transport/scatter_point.h"

namespace alhazen {

/// A surface where a subpath scatters, or where it ends at a light.
struct PathVertex {
    /// Not defaulted: all of it, which is large, would be zeroed first.
    PathVertex() {}  // NOLINT(modernize-use-equals-default)

    ShapeSurface surface;
    ScatterPoint scatter;
    Spectrum throughput;     ///< of the path up to the vertex
    bool hero_only = false;  ///< `throughput` is of the hero, and stands for all four wavelengths
    double density = 0;      ///< with which its own side finds it
    double reverse = 0;      ///< with which the other side would, once it has two more vertices
    double back = 0;         ///< by solid angle, of what it was found from, once it has one more
    bool singular = false;   ///< the path went on from it by a singular lobe
    MediumStack media;       ///< in front of it
    Spectrum emission;       ///< of it towards the path
    Illumination::EmitDensity emit;  ///< of that light
    double joined = 0;               ///< density with which it is drawn for the vertex before
    double distance = 0;             ///< from the vertex before
    double coverage = 1;             ///< with which the path stopped there

    [[nodiscard]] bool connects() const { return scatter.has_density(); }
};

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
          constant_(scene),
          bsdfs_(scene) {}

    /// Sets `vertices`. A path from the eye that leaves the scene sets `escaped`; its direction and
    /// density by solid angle are those of the last ray.
    void walk(Transport transport, const WalkStart& start, const WalkLuck& luck,
              std::vector<PathVertex>& vertices);

    struct Escape {
        bool is = false;
        Vec3 direction;
        Spectrum throughput;
        double density = 0;  ///< 1: singular
    };
    [[nodiscard]] const Escape& escape() const { return escape_; }

  private:
    /// The next surface on which the path stops; false where there is none.
    [[nodiscard]] bool find(Ray& ray, const WalkLuck& luck, float time, bool inside);

    const Scene& scene_;
    const Illumination& lights_;
    RayCounters& counters_;
    TraversalStats* stats_;
    MaterialCache constant_;
    BsdfCache bsdfs_;
    ShadingPoint point_;
    Hit hit_;
    double travelled_ = 0;  ///< since the last vertex
    double segment_ = 0;    ///< of it in the ray at hand
    std::uint32_t met_ = 0;
    RayKind kind_ = RayKind::Eye;
    Escape escape_;
};

}  // namespace alhazen
