#pragma once
/// Eye paths for renderers with photons: mirrors, smooth glass and glossy directions are traced,
/// lights are sampled, and all other light is estimated from photons.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 5 (the four parts of
/// the light that a surface scatters); Arvo and Kirk, "Particle Transport and Image Synthesis",
/// SIGGRAPH 1990 (when to split a path).
/// Differs: glossy is a property of a direction, not of a surface: the BSDF samples it with more
/// than kGlossyDensity. Direct light in such directions is weighted by the power heuristic, as both
/// strategies find it.
/// Conventions: pairs of dimensions as in light_transport/path_randomness.h. A pixel is independent
/// of threads and tiles. Emitters left to chance (illumination.h) are visible but do not
/// illuminate. Threads: used by one thread.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/renderers/light_transport/camera_rays.h"
#include "alhazen/renderers/light_transport/connection_batch.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/renderers/light_transport/power_heuristic.h"
#include "alhazen/renderers/photons/next_surface.h"

namespace alhazen {

/// A surface point seen by an eye path.
struct SeenPoint {
    const ShapeSurface& surface;
    const ScatterPoint& scatter;
    const PathEnd& path;  ///< the arriving path
    std::size_t waves;    ///< index in the wavelengths given to the eye
    PathNumbers numbers;  ///< random numbers for the point
};

/// A point in a volume seen by an eye path.
struct SeenVolume {
    const VolumePoint& place;
    const PathEnd& path;  ///< the arriving path
    std::size_t waves;    ///< as in SeenPoint
};

class PhotonEye {
  public:
    /// `waves`: sample `number` has those at number % size.
    PhotonEye(const RenderJob& job, RayCounters& counters, const Illumination& lights,
              const PathSettings& settings, std::span<const Wavelengths> waves);
    virtual ~PhotonEye() = default;
    PhotonEye(const PhotonEye&) = delete;
    PhotonEye& operator=(const PhotonEye&) = delete;

    /// `rays`: eye rays through the centre of the lens.
    void trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                       std::span<Rgb> radiance);

  protected:
    /// The radiance scattered by the point, without direct light and glossy directions.
    [[nodiscard]] virtual Spectrum photon_light(const SeenPoint& at) = 0;

    /// In-scattered radiance towards the eye at a point in a volume, over the scattering
    /// coefficient, without direct light.
    [[nodiscard]] virtual Spectrum photon_light(const SeenVolume& at) = 0;
    /// Direct light of a sampled light at a point in a volume, over the scattering coefficient,
    /// with the shadow ray.
    struct DirectLight {
        Spectrum light;
        Ray ray;
    };
    [[nodiscard]] DirectLight direct_light(const VolumePoint& at, double choice, const Vec2& place,
                                           const Wavelengths& waves) const;

    const RenderJob& job_;
    const Scene& scene_;
    RayCounters& counters_;
    const PathSettings settings_;
    ConnectionBatch shadows_;

  private:
    /// The state of a path in addition to its end.
    struct Last {
        bool singular = true;  ///< the last scattering was singular: no light was sampled for it
        double density = 0;
        LitPoint from;
        double eta_scale = 1;
        int scatterings = 0;
    };
    /// A branch of the path to be traced.
    struct Branch {
        PathEnd path;
        Last last;
        Wavelengths waves;         ///< wavelengths of the path, possibly the hero only
        bool straight = true;      ///< no scattering so far
        bool unlikely = false;     ///< a branch of probability below 1/2 was chosen
        std::uint64_t way = 0;     ///< hash of the pixel and the branches at smooth glass
        std::uint32_t stride = 1;  ///< one of this many successive samples takes this branch
    };
    /// `waves`: of the sample; must stay valid until the shadow rays are traced.
    void trace(const SampleId& id, const Ray& ray, const Wavelengths& waves, Spectrum& sum,
               Spectrum& direct);
    /// `event`: number of events with random numbers so far.
    void follow(const SampleId& id, Branch& at, int& event, const Wavelengths& waves, Spectrum& sum,
                Spectrum& direct);
    /// Weight of the photons at the directly visible point of the sample: 0, 1 or `every`.
    [[nodiscard]] double photon_lookups(const SampleId& id) const;
    /// Splits at smooth glass: `at` continues by the brighter branch; the other is stored, or taken
    /// by other samples. False if one must be chosen at random. `goes_on`: whether `at` continues.
    [[nodiscard]] bool follow_both(const SampleId& id, int& event, Branch& at, bool& goes_on);
    /// Number of samples, one of which follows a branch with that share of the light; 0 if it is
    /// left to chance.
    [[nodiscard]] std::uint32_t turns(const Branch& at, double share) const;
    /// Continues after a surface; false if the path ends.
    [[nodiscard]] bool leave(const SampleId& id, int& event, const Scattered& drawn,
                             Branch& at) const;
    [[nodiscard]] Spectrum escaped(const PathEnd& path, const Last& last) const;
    [[nodiscard]] Spectrum emitted(const Branch& at) const;
    void add_direct_light(const SampleId& id, int event, const Branch& at, const Wavelengths& waves,
                          Spectrum& direct);
    /// Random numbers for a light, stratified also over the samples of a branch that is taken in
    /// turn.
    [[nodiscard]] Vec2 draw_for_light(const SampleId& id, int event, const Branch& at,
                                      PathRandomness::BouncePair pair) const;
    /// Adds a shadow ray to the light selected by the numbers, for `share` of the direct light.
    void add_shadow_ray(const Branch& branch, double choice, const Vec2& place, double share,
                        const Wavelengths& waves, Spectrum& direct);
    void look_into_volume(const SampleId& id, int event, const PathEnd& path,
                          const Wavelengths& waves, Spectrum& sum, Spectrum& direct);
    [[nodiscard]] bool survives_roulette(PathEnd& path, const Last& last, const SampleId& id,
                                         int& event) const;

    const Illumination& lights_;
    DirectLightWeights weights_;
    PathRandomness random_;
    CameraRays camera_;
    NextSurface next_;
    ScatterPoint scatter_;
    const std::vector<Wavelengths> given_;
    std::vector<Spectrum> light_, direct_;  ///< [sample]
    std::vector<Wavelengths> waves_;        ///< [sample]
    std::vector<Branch> waiting_;           ///< branches of the current sample
    int splits_ = 0;                        ///< number of splits of the current sample
};

}  // namespace alhazen
