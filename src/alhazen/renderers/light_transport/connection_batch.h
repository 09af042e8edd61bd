#pragma once
/// Light along connections between points, which are gathered and tested for occlusion together.
///
/// Conventions: uncovered parts and thin sheets transmit light, tinted; refracting surfaces block
/// it, since the connection is straight. Null boundaries (ScatterPoint) transmit it
/// into the next volume; so do the openings of partly covering boundaries. Single-sided surfaces
/// block light from both sides; only eye rays pass their backs.

#include <memory>
#include <span>
#include <vector>

#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/light_transport/connecting_rays.h"
#include "alhazen/renderers/light_transport/free_flight.h"
#include "alhazen/renderers/light_transport/scattering_media.h"
#include "alhazen/renderers/volumes/coincident_faces.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

class ConnectionBatch {
  public:
    /// `sees`: what blocks light to a light.
    ConnectionBatch(const Scene& scene, RayCounters& counters, TraversalStats* stats,
                    RayMask sees = kConnectingRays);

    /// Adds `light` times the transmittance of `ray` up to its t_max to `sum`, in `finish` or
    /// before, in the order of the calls. `media`: around the origin of the ray. `waves` and `sum`
    /// must stay valid until `finish`.
    void add(const Ray& ray, float time, const MediumStack& media, const Wavelengths& waves,
             const Spectrum& light, Spectrum& sum);
    /// `add` for colour channels and a ray outside of all volumes. Always inlined: the ray is made
    /// where it is kept. A copy would wait for its parts.
    [[gnu::always_inline]] void add_outside(const Ray& ray, float time, const Spectrum& light,
                                            Spectrum& sum) {
        if (waiting_.size() == kMostRays) finish();
        if (light.is_black()) return;
        rays_[waiting_.size()] = ray;
        add_waiting(time, light, sum);
    }
    /// Casts the gathered rays.
    void finish();

    /// The transmittance of one ray. Adds the parts in scattering media to `flight`; may be null.
    [[nodiscard]] Spectrum passing(const Ray& ray, float time, const MediumStack& media,
                                   const Wavelengths& waves, FreeFlight* flight = nullptr);
    /// As `passing`, between two points that scatter: what rays of that kind meet blocks it.
    [[nodiscard]] Spectrum between(const Ray& ray, float time, RayKind kind,
                                   const MediumStack& media, const Wavelengths& waves,
                                   FreeFlight* flight) {
        return passing(ray, time, kind, media, waves, flight);
    }
    /// As `passing`, for an eye ray.
    [[nodiscard]] Spectrum seen(const Ray& from_eye, float time, const MediumStack& media,
                                const Wavelengths& waves, FreeFlight* flight = nullptr);

  private:
    struct Waiting {
        Spectrum light;
        const Wavelengths* waves;
        Spectrum* sum;
    };

    /// Rays per cast: enough to fill the stream kernel, and few enough for the cache.
    static constexpr std::size_t kMostRays = 512;

    /// Adds what belongs to the last ray.
    void add_waiting(float time, const Spectrum& light, Spectrum& sum);
    [[nodiscard]] RayQuery query(float time, RayKind kind = RayKind::Shadow) const {
        return {stats_, mask_for(kind), time};
    }
    [[nodiscard]] RayMask mask_for(RayKind kind) const {
        return kind == RayKind::Shadow ? connecting_ : mask_of(kind);
    }
    /// The volumes around a point that rays to lights see. Valid until the next call.
    [[nodiscard]] const MediumStack& seen_of(const MediumStack& media);
    void find_met(std::span<bool> met);
    /// Finds the surfaces that a ray passes. False if one blocks it.
    [[nodiscard]] bool find_crossings(const Ray& ray, float time, RayKind kind);
    /// The transmittance of the surfaces on a ray that hits some.
    [[nodiscard]] Spectrum through_surfaces(const Ray& ray, float time, RayKind kind,
                                            const Wavelengths& waves);
    /// The transmittance of the surfaces and volumes on a ray. `met`: it hits some surface.
    [[nodiscard]] Spectrum through_volumes(const Ray& ray, float time, RayKind kind,
                                           const MediumStack& media, const Wavelengths& waves,
                                           bool met, FreeFlight* flight);
    /// The transmittance of a surface. `media`: the volumes before it, then those behind it; null:
    /// volumes are not followed.
    [[nodiscard]] Spectrum through(const Ray& ray, float time, RayKind kind, const Hit& crossing,
                                   const Wavelengths& waves, MediumStack* media);
    /// True if the face of the hit was crossed with one before.
    [[nodiscard]] bool is_crossed(const Ray& ray, const Hit& hit, float time);
    [[nodiscard]] Spectrum passing(const Ray& ray, float time, RayKind kind,
                                   const MediumStack& media, const Wavelengths& waves,
                                   FreeFlight* flight);

    const Scene& scene_;
    RayCount& count_;
    TraversalStats* stats_;
    RayMask connecting_;
    ScatteringMedia media_;
    CoincidentFaces faces_;
    bool has_single_sided_;
    std::vector<Ray> rays_;  ///< kMostRays, of which the first wait
    std::vector<Waiting> waiting_;
    std::vector<float> times_;
    MediumStack seen_;                 ///< result of `seen_of`
    std::vector<MediumStack> around_;  ///< [ray]; only if volumes are followed
    std::unique_ptr<bool[]> met_;
    std::vector<Hit> crossings_;
    CrossedFaces crossed_;
    double last_face_ = 0;  ///< t of the last face of a volume that was crossed
    Surface surface_;       ///< of `is_crossed`
};

}  // namespace alhazen
