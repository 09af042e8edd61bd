#pragma once
/// Light that reaches a point from a lamp by way of a mirror or of glass, found by walks on the
/// manifold of specular chains: what shadow rays are for light that comes straight.
///
/// Source: Hanika, Droske and Fascione, "Manifold Next Event Estimation", EGSR 2015; Zeltner,
/// Georgiev and Jakob, "Specular Manifold Sampling for Rendering High-Frequency Caustics and
/// Glints", SIGGRAPH 2020, section 4.2 (the unbiased estimate: a chain counts as often as the walk
/// has to be repeated until it finds the chain again); Booth, "Unbiased Monte Carlo Estimation of
/// the Reciprocal of an Integral", 2007.
/// Differs: at spheres and in planes all chains are known in closed form, and none is left to
/// chance. Elsewhere the chain that a likely seed leads to counts once, as in the first source, and
/// random seeds are for the others. Lights are picked by power and points of them by area. There is
/// no weight shared with paths: a chain towards a light that can be hit counts here where the
/// surface at its beginning spreads light as widely as kMostDensity, and else by paths alone.
/// Conventions: chains of one reflection, one refraction or two refractions, at one part
/// (specular_parts.h).
/// Threads: a ManifoldScene is shared; each thread has a ManifoldLight of its own.

#include <atomic>
#include <optional>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/light_transport/light_batch.h"
#include "alhazen/renderers/light_transport/path_chance.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/manifold/specular_parts.h"
#include "alhazen/renderers/manifold/sphere_chains.h"

namespace alhazen {

/// The chain of single directions at the end of an eye path, since it last met a surface that
/// spreads light.
struct ChainTrail {
    static constexpr std::uint8_t kNone = 255;
    std::uint8_t length = kNone;  ///< kNone: it is not of the kinds that are sought
    bool refracted = false;       ///< all of it; else all reflected
    std::uint64_t part = 0;

    /// The path was spread, with that density of its direction.
    void begin(double density);
    /// It went on in a single direction.
    void go_on(const Surface& surface, bool transmitted);
};

struct ManifoldScene {
    ManifoldScene(const Scene& scene, const Illumination& lights);

    [[nodiscard]] bool finds_any() const { return !parts.empty() && lights.picks_any(); }
    /// Whether ManifoldLight finds the light that the path of the trail hit, or may.
    [[nodiscard]] bool finds(const ChainTrail& trail, const Hit& hit, const Surface& surface,
                             const Vec3& direction) const;

    SpecularParts parts;
    /// Numbers of parts: those that are asked at every point, and those of which one is.
    std::vector<std::size_t> always, by_chance;
    const Illumination& lights;
    /// Estimates that ended after kMostTrials: their light is too dark.
    mutable std::atomic<std::uint64_t> cut{0};
};

/// By solid angle, of directions in which a surface counts as spreading: a matt one has 1 / pi.
inline constexpr double kMostDensity = 1.0;
inline constexpr std::uint32_t kMostTrials = 4096;

class ManifoldLight {
  public:
    ManifoldLight(const Scene& scene, const ManifoldScene& manifold, RayCounters& counters,
                  LightBatch& shadows)
        : scene_(scene), manifold_(manifold), tracer_(scene, counters), shadows_(shadows) {}

    /// The point at which light arrives.
    struct Receiver {
        const Surface& surface;
        const ScatterPoint& scatter;
        const MediumStack& media;  ///< in front of it
        float time;
        const Wavelengths& waves;
        int most_bends;  ///< longest chain that is wanted
        const PathChance& chance;
        const SampleId& id;
        std::uint32_t place;  ///< of its random numbers
    };
    /// Light that arrives along `direction` after `bends`, times what the point does with it.
    struct Arrived {
        Vec3 direction;
        int bends = 0;
        Spectrum light;
    };
    /// Calls `tell(const Arrived&)` for each chain that is found.
    template <class Tell>
    void find(const Receiver& at, Tell&& tell) {
        found_.clear();
        if (at.most_bends > 0 && begin(at)) {
            for (const std::size_t i : manifold_.always) find_by({&manifold_.parts[i], 1.0});
            if (!manifold_.by_chance.empty()) find_by(choose_part(next_number()));
        }
        for (const Arrived& arrived : found_) tell(arrived);
    }

  private:
    struct Choice {
        const SpecularPart* part = nullptr;
        double probability = 0;
    };
    /// Picks a light; false: there is none.
    [[nodiscard]] bool begin(const Receiver& at);
    [[nodiscard]] double next_number() { return at_->chance.extra(at_->id, at_->place, number_++); }
    void find_by(const Choice& part);
    [[nodiscard]] Choice choose_part(double choice) const;
    [[nodiscard]] bool may_be(ChainKind kind) const;
    void find_kind(ChainKind kind);
    /// Directions of all chains of the part; empty: they are not known.
    [[nodiscard]] std::optional<ChainSeeds> all_seeds(ChainKind kind);
    /// Where the chain often is.
    [[nodiscard]] std::optional<Vec3> likely_seed(ChainKind kind) const;
    [[nodiscard]] Vec3 random_seed(ChainKind kind);
    [[nodiscard]] Vec3 straight() const {
        return normalize(end_.infinite ? end_.at : end_.at - at_->surface.point);
    }
    void find_by_trials(ChainKind kind);
    /// The chain along a direction, its indices found.
    [[nodiscard]] bool set_out(ChainKind kind, const Vec3& direction);
    /// A chain to the light from that direction on.
    [[nodiscard]] bool reach(ChainKind kind, const Vec3& seed);
    /// The same where the bend at the seed is beyond the critical angle, after `set_out` failed
    /// there: the indices rise from 1 on, the chain follows.
    [[nodiscard]] bool reach_by_indices(ChainKind kind, const Vec3& seed);
    /// What comes along chain_.
    [[nodiscard]] Spectrum light_along();
    [[nodiscard]] Spectrum through_vertices(MediumStack& media);
    [[nodiscard]] Spectrum unhindered(const MediumStack& first, const MediumStack& last);
    void note(const Spectrum& light, double times);
    [[nodiscard]] MediumStack media_along(const Vec3& direction) const;

    const Scene& scene_;
    const ManifoldScene& manifold_;
    ChainTracer tracer_;
    LightBatch& shadows_;

    const Receiver* at_ = nullptr;
    std::uint32_t number_ = 0;
    Illumination::LightPick pick_;
    ChainEnd end_;
    Choice part_;
    Chain chain_;
    ChainIndices indices_;
    int known_indices_ = 0;
    ShadingPoint point_;
    ScatterPoint vertex_;
    std::vector<Arrived> found_;
};

}  // namespace alhazen
