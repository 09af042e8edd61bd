#pragma once
/// The paths of a batch of samples, one bounce of all of them at a time.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/illumination/light_draws.h"
#include "alhazen/renderers/core/path_record.h"
#include "alhazen/renderers/core/visible_batch.h"
#include "alhazen/renderers/light_transport/camera_rays.h"
#include "alhazen/renderers/light_transport/light_batch.h"
#include "alhazen/renderers/light_transport/light_layers.h"
#include "alhazen/renderers/light_transport/path_chance.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/renderers/light_transport/polarized_path.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/light_transport/scattering_media.h"
#include "alhazen/renderers/manifold/manifold_light.h"

namespace alhazen {

/// A path so far, and the ray that continues it.
struct EyePath {
    /// Not defaulted: all of it would be zeroed first.
    EyePath() {}  // NOLINT(modernize-use-equals-default)

    // Read by VisibleBatch.
    RayKind kind = RayKind::Eye;
    bool inside = false;
    float time = 0;
    RayCone cone;

    std::uint32_t sample = 0;   ///< of the batch
    std::uint32_t met = 0;      ///< surfaces on its way
    std::uint32_t stretch = 0;  ///< stretches through what scatters
    int scatterings = 0;
    int drawn = 0;  ///< scatterings and straight passes: places of its random numbers
    Spectrum throughput{1, 1, 1, 1};
    double eta_scale = 1;  ///< of radiance, undone where roulette looks at the throughput
    bool singular = true;  ///< the last scattering: no light is sampled for it
    double density = 0;    ///< of the last scattering
    LitPoint from;         ///< the last scattering
    double travelled = 0;  ///< since then
    MediumStack media;
    FirstScattering first;  ///< only where layers of light are wanted
    ChainTrail trail;       ///< only where chains are sought
};

class PathTracer {
  public:
    PathTracer(const RenderJob& job, std::size_t, RayCounters& counters, const Illumination& lights,
               const PathSettings& settings, LightLayers* layers,
               const ManifoldScene* manifold = nullptr);

    /// `rays`: those through the centre of the lens.
    void trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                       std::span<Rgb> radiance);

  private:
    /// Light that a shadow ray may bring, for the layers and where it is polarised.
    struct JoinedLight {
        std::uint32_t sample;
        int scatterings;
        FirstScattering first;
        Spectrum light;
    };

    /// A surface where a path scatters.
    struct Vertex {
        EyePath* path = nullptr;
        const ShadingPoint* point = nullptr;  ///< where vertices do not wait; else null
        Vec3 place;
        ScatterPoint scatter;
        std::optional<LeavingRays> leaving;
    };

    void bounce(bool first);
    /// Goes on from the vertices that wait.
    void scatter_all();
    /// The vertex of the path that is recorded (RenderJob::path); null of others.
    [[nodiscard]] RecordedVertex* recorded(const EyePath& path) {
        return path.sample == recorded_ ? &job_.path->vertices.back() : nullptr;
    }
    void begin_record();
    void record_ray(const EyePath& path, const Ray& ray, const ShadingPoint* point, double t);
    void record_step(const EyePath& path, PathStep step) {
        if (RecordedVertex* vertex = recorded(path)) vertex->step = step;
    }
    /// Where light that a shadow ray may bring waits; null where it is not recorded.
    [[nodiscard]] Spectrum* record_shadow(const EyePath& path, const Ray& shadow,
                                          const Spectrum& light);
    void record_arrival();
    /// Adds light at the end of a path to its sample.
    void add(const EyePath& path, const Spectrum& light, Spectrum& sum);
    /// Whether joined light waits apart from the sums of the samples.
    [[nodiscard]] bool joins_apart() const { return layers_ != nullptr || settings_.polarization; }
    void add_joined();
    /// `light`: what would arrive if none were polarised; `to_eye`: of which this arrives.
    void add_polarized(std::uint32_t sample, int scatterings, const FirstScattering& first,
                       const Spectrum& light, const StokesLight& to_eye);
    /// Where light from `direction` at the point at hand goes that a shadow ray may bring;
    /// `scatter` null: scattered inside a volume.
    [[nodiscard]] Spectrum& place_of_joined(const EyePath& path, const FirstScattering& first,
                                            const ScatterPoint* scatter, const Vec3& direction,
                                            Spectrum& sum);
    /// Light that may still be blocked.
    [[nodiscard]] Spectrum limited_joined(const Spectrum& light, int scatterings) const {
        return settings_.polarization ? light : limited(light, scatterings);
    }
    /// Along a ray of length `t` in the medium around it; true: the path was scattered on the way,
    /// and has gone on or ended.
    [[nodiscard]] bool cross_medium(EyePath& path, const Medium& medium, const Ray& ray, double t,
                                    Spectrum& sum);
    void scatter_in_volume(EyePath& path, const Medium& medium, const Ray& ray, Spectrum& sum);
    /// Fetches what paths after the `k`-th will read when they draw a light.
    void fetch_ahead(std::size_t k);
    void escape(const EyePath& path, const Ray& ray, Spectrum& sum);
    /// Goes straight on where the surface does not cover.
    void pass(EyePath& path, const Ray& ray, const ShadingPoint& point);
    void meet(EyePath& path, const Ray& ray, const Hit& hit, const ShadingPoint& point, double t,
              Spectrum& sum);
    /// At the surface where the path stops: what its light does there.
    void stop(EyePath& path, const Ray& ray, const Hit& hit, const ShadingPoint& point,
              Spectrum& sum);
    void add_emission(const EyePath& path, const Ray& ray, const Hit& hit,
                      const ShadingPoint& point, Spectrum& sum);
    /// The numbers of choices at the next scattering. `needed`: some choice is not certain.
    [[nodiscard]] Vec2 choices(const EyePath& path, bool needed) {
        return needed ? chance_.draw(path.sample, path.drawn, PathChance::kChoices) : Vec2{};
    }
    void add_direct_light(const Vertex& vertex, const LightDraw& drawn, Spectrum& sum);
    /// Light by way of mirrors and glass.
    void add_chains(const Vertex& vertex, Spectrum& sum);
    /// `drawn`: where the path goes; none: it is absorbed.
    void scatter(const Vertex& vertex, const std::optional<Scattered>& drawn);
    /// Where their paths go, matt ones together.
    void draw_directions(std::span<const Vertex> vertices);
    /// What a scattering along `direction` does with light, where it is the first.
    [[nodiscard]] FirstScattering first_along(const Vertex& vertex, const Vec3& direction) const;
    [[nodiscard]] bool survives(EyePath& path);
    void go_on(const EyePath& path, const Ray& ray) {
        next_alive_.push_back(path.sample);
        next_rays_.push_back(ray);
    }
    /// Of a sample; drawn when they are asked for: paths that find nothing have none.
    [[nodiscard]] const Wavelengths& waves_of(std::uint32_t sample) {
        if (!chance_.is_spectral()) return kColorChannels;
        Wavelengths& waves = waves_[sample];
        if (!waves.is_spectral()) waves = chance_.waves(sample);
        return waves;
    }
    [[nodiscard]] const Wavelengths& waves(const EyePath& path) { return waves_of(path.sample); }
    /// The path goes on as that of the hero.
    void keep_hero(EyePath& path) {
        if (!chance_.is_spectral()) return;
        static_cast<void>(waves(path));
        waves_[path.sample].keep_hero(path.throughput);
    }
    /// Light at the end of a path of that many scatterings.
    [[nodiscard]] Spectrum limited(const Spectrum& light, int scatterings) const {
        const double limit = limit_of(light, scatterings);
        return limit < 1.0 ? limit * light : light;
    }
    [[nodiscard]] double limit_of(const Spectrum& light, int scatterings) const;

    const RenderJob& job_;
    const Scene& scene_;
    const Illumination& lights_;
    bool fetches_;        ///< Illumination::looks_up
    bool chooses_light_;  ///< Illumination::chooses
    PathSettings settings_;
    RayCounters& counters_;
    PathChance chance_;
    CameraRays camera_;
    VisibleBatch visible_;
    LightBatch shadows_;
    BsdfCache bsdfs_;
    ScatterPoint passed_;
    /// Vertices wait for each other, for their lights are drawn together.
    std::array<Vertex, LightDraws::kMost> vertices_;
    std::size_t waiting_ = 0, most_waiting_;
    LightDraws draws_;
    std::array<std::optional<Scattered>, LightDraws::kMost> directions_;  ///< [waiting vertex]
    CoincidentFaces faces_;
    ShadingPoint opaque_face_;  ///< of them, where it is met
    ScatteringMedia media_;
    MediumStack behind_;             ///< the surface at hand
    LightLayers* layers_;            ///< null: none is wanted
    const ManifoldScene* manifold_;  ///< null: no chains are sought
    std::optional<ManifoldLight> chains_;
    std::vector<LightParts> parts_;  ///< [sample of the batch]
    std::vector<JoinedLight> joined_;
    std::vector<StokesLight> joined_to_eye_;  ///< [joined]; empty unless light is polarised
    std::vector<PolarizedPath> polarized_;    ///< [sample of the batch]; the same
    std::span<const SampleId> ids_;
    static constexpr std::uint32_t kNoSample = 0xFFFFFFFFu;
    std::uint32_t recorded_ = kNoSample;  ///< of the batch
    Spectrum recorded_arrival_;
    std::vector<Wavelengths> waves_;  ///< [sample of the batch]; of channels: not yet drawn
    std::vector<Spectrum> light_;     ///< [sample of the batch]
    std::vector<EyePath> paths_;      ///< [sample of the batch]
    std::vector<std::uint32_t> alive_, next_alive_;  ///< samples of the batch whose paths go on
    std::vector<Ray> rays_, next_rays_;              ///< [alive]
};

}  // namespace alhazen
