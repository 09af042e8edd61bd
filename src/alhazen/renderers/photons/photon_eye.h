#pragma once
/// Paths from the eye for renderers with photons: mirrors, smooth glass and glossy directions are
/// followed, lights are sampled, and all other light is that of photons.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 5 (the four parts of
/// the light that a surface scatters); Arvo and Kirk, "Particle Transport and Image Synthesis",
/// SIGGRAPH 1990 (when to split a path).
/// Differs: glossy is a direction, not a surface: where the BSDF samples it with more than
/// kGlossyDensity. Direct light of those is weighed by the power heuristic, as both ways find it.
/// Conventions: pairs of dimensions as in light_transport/path_chance.h. A pixel depends neither on
/// the threads nor on tiles. Emitters that are left to chance (illumination.h) are seen, and light
/// nothing.
/// Threads: used by one thread.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/renderers/light_transport/camera_rays.h"
#include "alhazen/renderers/light_transport/light_batch.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/renderers/photons/next_surface.h"

namespace alhazen {

/// A surface that is looked at.
struct SeenPoint {
    const ShapeSurface& surface;
    const ScatterPoint& scatter;
    const PathEnd& path;  ///< that arrived
    std::size_t waves;    ///< which of those that the eye was given
    PathNumbers numbers;  ///< for what is drawn there
};

/// A place in a volume that is looked at.
struct SeenVolume {
    const VolumePoint& place;
    const PathEnd& path;  ///< that arrived
    std::size_t waves;    ///< as of SeenPoint
};

class PhotonEye {
  public:
    /// `waves`: of which sample `number` has those at number % size.
    PhotonEye(const RenderJob& job, RayCounters& counters, const Illumination& lights,
              const PathSettings& settings, std::span<const Wavelengths> waves);
    virtual ~PhotonEye() = default;
    PhotonEye(const PhotonEye&) = delete;
    PhotonEye& operator=(const PhotonEye&) = delete;

    /// `rays`: those through the centre of the lens.
    void trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                       std::span<Rgb> radiance);

  protected:
    /// The radiance that the point scatters, without direct light and glossy directions.
    [[nodiscard]] virtual Spectrum photon_light(const SeenPoint& at) = 0;

    /// The radiance that arrives at a place in a volume and goes on to the eye, over the
    /// coefficient, without direct light.
    [[nodiscard]] virtual Spectrum photon_light(const SeenVolume& at) = 0;
    /// Direct light at a place in a volume, over the coefficient: that of a light drawn, with the
    /// ray towards it.
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
    LightBatch shadows_;

  private:
    /// The state of a path besides its end.
    struct Last {
        bool singular = true;  ///< the last scattering: no light is sampled for it
        double density = 0;
        LitPoint from;
        double eta_scale = 1;
        int scatterings = 0;
    };
    /// A way that is yet to be followed.
    struct Branch {
        PathEnd path;
        Last last;
        Wavelengths waves;         ///< of the path, which may have only the hero left
        bool straight = true;      ///< no surface has been left yet
        bool unlikely = false;     ///< by chance it went a way of less than a half
        std::uint64_t way = 0;     ///< hash of the pixel and the ways gone at smooth glass
        std::uint32_t stride = 1;  ///< of so many successive samples one goes here
    };
    /// `waves`: of the sample; shadow rays keep them until they are cast.
    void trace(const SampleId& id, const Ray& ray, const Wavelengths& waves, Spectrum& sum,
               Spectrum& direct);
    /// `event`: at how many places the sample has drawn so far, for random numbers.
    void follow(const SampleId& id, Branch& at, int& event, const Wavelengths& waves, Spectrum& sum,
                Spectrum& direct);
    /// How many times the photons of what the sample sees straight count: 0, 1 or `every`.
    [[nodiscard]] double looks(const SampleId& id) const;
    /// Goes on by both ways at smooth glass: `at` by the brighter one, while the other one waits or
    /// is the turn of another sample. False where one is to be chosen. `goes_on`: of `at`.
    [[nodiscard]] bool follow_both(const SampleId& id, int& event, Branch& at, bool& goes_on);
    /// Of how many samples that follow `at` one follows what has that share of the light: 0 where
    /// that is left to chance.
    [[nodiscard]] std::uint32_t turns(const Branch& at, double share) const;
    /// Leaves a surface; false where the path ends.
    [[nodiscard]] bool leave(const SampleId& id, int& event, const Scattered& drawn,
                             Branch& at) const;
    [[nodiscard]] Spectrum escaped(const PathEnd& path, const Last& last) const;
    [[nodiscard]] Spectrum emitted(const Branch& at) const;
    void add_direct_light(const SampleId& id, int event, const Branch& at, const Wavelengths& waves,
                          Spectrum& direct);
    /// Random numbers for a light. Those of a way that is gone in turn are as even over its turns
    /// as others over all samples.
    [[nodiscard]] Vec2 draw_for_light(const SampleId& id, int event, const Branch& at,
                                      PathChance::BouncePair pair) const;
    /// To a light that the numbers choose, for `share` of the direct light.
    void add_shadow_ray(const Branch& branch, double choice, const Vec2& place, double share,
                        const Wavelengths& waves, Spectrum& direct);
    void look_into_volume(const SampleId& id, int event, const PathEnd& path,
                          const Wavelengths& waves, Spectrum& sum, Spectrum& direct);
    [[nodiscard]] bool survives(PathEnd& path, const Last& last, const SampleId& id,
                                int& event) const;

    const Illumination& lights_;
    PathChance chance_;
    CameraRays camera_;
    NextSurface next_;
    ScatterPoint scatter_;
    const std::vector<Wavelengths> given_;
    std::vector<Spectrum> light_, direct_;  ///< [sample]
    std::vector<Wavelengths> waves_;        ///< [sample]
    std::vector<Branch> waiting_;           ///< of the sample in hand
    int splits_ = 0;                        ///< the same
};

}  // namespace alhazen
