#pragma once
/// Light that reaches a point from a light by way of a mirror or of glass, found by manifold walks
/// of specular chains: the counterpart of shadow rays for specular paths.
///
/// Source: Hanika, Droske and Fascione, "Manifold Next Event Estimation", EGSR 2015; Zeltner,
/// Georgiev and Jakob, "Specular Manifold Sampling for Rendering High-Frequency Caustics and
/// Glints", SIGGRAPH 2020, section 4.2 (the unbiased estimate: a chain is weighted by the number of
/// trials until the walk finds it again); Booth, "Unbiased Monte Carlo Estimation of the Reciprocal
/// of an Integral", 2007.
/// Differs: at spheres and in planes all chains are known in closed form and summed. Elsewhere the
/// chain found from a likely seed counts once, as in the first source, and random seeds find the
/// others. Lights are sampled by power and their points by area. No multiple importance sampling
/// with paths: a chain towards a light that rays can hit is counted here if the density at the
/// surface where it begins is at most kMostDensity, and otherwise by paths only.
/// Conventions: chains of one reflection, one refraction or two refractions, at one part
/// (specular_parts.h).
/// Threads: a ManifoldScene is shared; each thread has its own ManifoldLight.

#include <atomic>
#include <optional>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/light_transport/connection_batch.h"
#include "alhazen/renderers/light_transport/path_randomness.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/manifold/specular_parts.h"
#include "alhazen/renderers/manifold/sphere_chains.h"

namespace alhazen {

/// The specular chain at the end of an eye path, since its last non-specular scattering.
struct ChainTrail {
    static constexpr std::uint8_t kNone = 255;
    std::uint8_t length = kNone;  ///< kNone: not of the kinds found here
    bool refracted = false;       ///< true: all refractions; else all reflections
    std::uint64_t part = 0;

    /// Starts after a scattering with that density of its direction.
    void begin(double density);
    /// Continues by a reflection or refraction.
    void go_on(const Surface& surface, bool transmitted);
};

struct ManifoldScene {
    ManifoldScene(const Scene& scene, const Illumination& lights);

    [[nodiscard]] bool finds_any() const { return !parts.empty() && lights.picks_any(); }
    /// True if ManifoldLight finds, or may find, the light that the path of the trail hit.
    [[nodiscard]] bool finds(const ChainTrail& trail, const Hit& hit, const Surface& surface,
                             const Vec3& direction) const;

    SpecularParts parts;
    /// Indices of parts: searched at every point, and chosen at random.
    std::vector<std::size_t> always, by_chance;
    const Illumination& lights;
    /// Number of estimates truncated after kMostTrials, which are too dark.
    mutable std::atomic<std::uint64_t> cut{0};
};

/// Largest density, by solid angle, of a direction of a surface that counts as diffuse; that of a
/// matt surface is at most 1 / pi.
inline constexpr double kMostDensity = 1.0;
inline constexpr std::uint32_t kMostTrials = 4096;

class ManifoldLight {
  public:
    ManifoldLight(const Scene& scene, const ManifoldScene& manifold, RayCounters& counters,
                  ConnectionBatch& shadows)
        : scene_(scene), manifold_(manifold), tracer_(scene, counters), shadows_(shadows) {}

    /// The point at which light arrives.
    struct Receiver {
        const Surface& surface;
        const ScatterPoint& scatter;
        const MediumStack& media;  ///< in front of it
        float time;
        const Wavelengths& waves;
        int most_bends;  ///< longest chain to be found
        const PathRandomness& random;
        const SampleId& id;
        std::uint32_t place;  ///< dimension of its random numbers
    };
    /// Light that arrives along `direction` after `bends`, times the BSDF at the point.
    struct Arrived {
        Vec3 direction;
        int bends = 0;
        Spectrum light;
    };
    /// Calls `tell(const Arrived&)` for each chain found.
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
    /// Samples a light; false if there is none.
    [[nodiscard]] bool begin(const Receiver& at);
    [[nodiscard]] double next_number() { return at_->random.extra(at_->id, at_->place, number_++); }
    void find_by(const Choice& part);
    [[nodiscard]] Choice choose_part(double choice) const;
    [[nodiscard]] bool may_be(ChainKind kind) const;
    void find_kind(ChainKind kind);
    /// Directions of all chains of the part; empty if they are unknown.
    [[nodiscard]] std::optional<ChainSeeds> all_seeds(ChainKind kind);
    /// A direction in which the chain is likely.
    [[nodiscard]] std::optional<Vec3> likely_seed(ChainKind kind) const;
    [[nodiscard]] Vec3 random_seed(ChainKind kind);
    [[nodiscard]] Vec3 straight() const {
        return normalize(end_.infinite ? end_.at : end_.at - at_->surface.point);
    }
    void find_by_trials(ChainKind kind);
    /// Sets the chain along a direction, with its indices.
    [[nodiscard]] bool set_out(ChainKind kind, const Vec3& direction);
    /// Walks to a chain to the light, from that direction.
    [[nodiscard]] bool reach(ChainKind kind, const Vec3& seed);
    /// The same after `set_out` failed because of total reflection at the seed: the indices are
    /// raised from 1 in steps, and the chain is followed.
    [[nodiscard]] bool reach_by_indices(ChainKind kind, const Vec3& seed);
    /// The contribution along chain_.
    [[nodiscard]] Spectrum light_along();
    [[nodiscard]] Spectrum through_vertices(MediumStack& media);
    [[nodiscard]] Spectrum unhindered(const MediumStack& first, const MediumStack& last);
    void note(const Spectrum& light, double times);
    [[nodiscard]] MediumStack media_along(const Vec3& direction) const;

    const Scene& scene_;
    const ManifoldScene& manifold_;
    ChainTracer tracer_;
    ConnectionBatch& shadows_;

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
