#pragma once
/// Subpaths from the eye or from a light, also through scattering volumes.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapters 8 and
/// 10.
/// Conventions: densities are those of path_vertex.h. Singular directions have density 1 by solid
/// angle in both directions, since every strategy has the same factor. Surfaces that a path passes
/// straight (coverage, thin sheets) are no vertices.

#include <cstdint>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/coincident_surfaces.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/light_transport/met_faces.h"
#include "alhazen/renderers/light_transport/passed_surfaces.h"
#include "alhazen/renderers/light_transport/path_randomness.h"
#include "alhazen/renderers/light_transport/path_vertex.h"
#include "alhazen/renderers/light_transport/scattering_media.h"

namespace alhazen {

/// The first segment of a light path, by which strategies find the same light.
enum class FirstSegment : std::uint8_t {
    Any,        ///< all of them
    Connected,  ///< shadow rays: it passes what connections pass, and ends where light scatters by
                ///< a density
    Hit,        ///< rays that hit the light: after it the path continues by a singular lobe
};

/// The beginning of a walk.
struct WalkStart {
    Ray ray;
    Spectrum throughput{1, 1, 1, 1};
    const Wavelengths* waves = &kColorChannels;  ///< initial wavelengths of the path
    /// By solid angle; if `parallel`, by area perpendicular to the ray; 0: singular.
    double density = 0;
    bool parallel = false;
    /// The first segment passes what connections to the light pass: no ray hits the light, so that
    /// all other strategies connect to it.
    bool as_connection = false;
    /// Connections to the light and rays that hit it pass different parts: the first segment is of
    /// either kind (FirstSegment).
    bool of_either = false;
    float time = 0;
    MediumStack media;  ///< around the origin
};

/// Random numbers and limits of a walk.
struct WalkRandomness {
    const PathRandomness& random;
    const SampleId& id;
    std::uint32_t first_pair;  ///< of the first bounce; kWalkPairs for each
    int most;                  ///< largest number of vertices
    int roulette;              ///< number of vertices after which Russian roulette begins
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
          faces_(scene),
          here_(scene),
          surfaces_(scene, stats) {}

    /// Sets `vertices`. If a path from the eye leaves the scene, sets `escape()` to direction and
    /// density by solid angle of its last ray.
    void walk(Transport transport, const WalkStart& start, const WalkRandomness& draws,
              std::vector<PathVertex>& vertices);

    struct Escape {
        bool is = false;
        Vec3 direction;
        Spectrum throughput;
        double density = 0;   ///< 1: singular
        double backward = 1;  ///< as in PathVertex
    };
    [[nodiscard]] const Escape& escape() const { return escape_; }

  private:
    /// The current end of a walk.
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

    /// Chooses between the kinds of first segments.
    void choose_first(Front& front, const WalkRandomness& draws);
    /// True if a path may continue by that kind of lobe after the segment.
    [[nodiscard]] bool continues(bool singular) const {
        if (singular) return !passed_ && first_ != FirstSegment::Connected;
        return first_ != FirstSegment::Hit;
    }
    [[nodiscard]] RayMask mask() const {
        return connects_ && !passed_ ? kConnectingRays : mask_of(kind_);
    }
    /// Finds the next stop: a surface, or a point in a volume, which becomes the origin of the ray.
    [[nodiscard]] Meets find(Front& front, const WalkRandomness& draws, const WalkStart& start);
    /// Applies the absorption of a medium that does not scatter.
    void absorb(Front& front, double length) const;
    /// True if the path stops at the surface that was hit, or at one behind it at the same place,
    /// which is then the surface hit; else `beyond_` is the ray behind them.
    [[nodiscard]] bool stops_here(Front& front, const Arrival& arrival,
                                  const WalkRandomness& draws);
    /// Enters or leaves a volume through an uncovered part of its boundary.
    void pass_opening(Front& front);
    /// Samples a segment of that length in a scattering medium. True if the path scatters in it.
    [[nodiscard]] bool scatters_within(Front& front, const Medium& medium,
                                       const VolumeScattering& scattering, double length,
                                       const WalkRandomness& draws, const WalkStart& start);
    /// The last vertex and the one before; null for the first vertex.
    struct Ends {
        PathVertex& v;
        PathVertex* before;
        bool last;  ///< the walk has its largest number of vertices
    };
    /// Sets position, density and media of the vertex. Forced inline, as `scatter_at_surface`:
    /// light_tracing takes half a per cent fewer instructions.
    [[gnu::always_inline]] inline void set_vertex(const Front& front, const WalkStart& start,
                                                  Meets meets, const Ends& ends);
    void set_emission(const Front& front, const Ends& ends) const;
    /// Sets emission and scattering of a vertex on a surface and continues the walk.
    [[nodiscard, gnu::always_inline]] inline Step scatter_at_surface(Transport transport,
                                                                     Front& front,
                                                                     const WalkRandomness& draws,
                                                                     std::uint32_t pair,
                                                                     const Ends& ends);
    [[nodiscard]] Step scatter_in_volume(Front& front, const WalkRandomness& draws,
                                         std::uint32_t pair, const Ends& ends);

    const Scene& scene_;
    const Illumination& lights_;
    RayCounters& counters_;
    TraversalStats* stats_;
    ScatteringMedia scattering_;
    MaterialCache constant_;
    BsdfCache bsdfs_;
    ShadingPoint point_;
    MetFaces faces_;  ///< at the point
    CoincidentSurfaces here_;
    Ray beyond_;
    PassedSurfaces surfaces_;
    ScatterPoint opening_;  ///< a surface that is passed at an uncovered part
    Hit hit_;
    double travelled_ = 0;  ///< distance since the last vertex
    double segment_ = 0;    ///< distance whose absorption is not yet applied
    std::uint32_t met_ = 0;
    std::uint32_t stretch_ = 0;  ///< number of segments through scattering media
    FreeFlight flight_;          ///< since the last vertex
    double eta_scale_ = 1;
    RayKind kind_ = RayKind::Eye;
    bool connects_ = false;                   ///< the segment passes what connections pass
    FirstSegment first_ = FirstSegment::Any;  ///< of the segment; others than the first: Any
    bool chooses_ = false;                    ///< it may end at surfaces that do not block it
    bool passed_ = false;                     ///< `hit_` is such a surface
    std::uint32_t chosen_ = 0;                ///< number of choices
    Escape escape_;
};

}  // namespace alhazen
