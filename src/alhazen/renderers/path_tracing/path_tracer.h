#pragma once
/// Path tracing of a batch of samples, one bounce of all paths at a time.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/illumination/light_draws.h"
#include "alhazen/renderers/core/path_record.h"
#include "alhazen/renderers/core/visible_batch.h"
#include "alhazen/renderers/light_transport/camera_rays.h"
#include "alhazen/renderers/light_transport/connection_batch.h"
#include "alhazen/renderers/light_transport/matt_directions.h"
#include "alhazen/renderers/light_transport/met_faces.h"
#include "alhazen/renderers/light_transport/path_randomness.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/renderers/light_transport/polarized_path.h"
#include "alhazen/renderers/light_transport/power_heuristic.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/light_transport/scattering_media.h"
#include "alhazen/renderers/manifold/manifold_light.h"
#include "alhazen/renderers/path_tracing/light_layers.h"
#include "alhazen/renderers/path_tracing/plain_meshes.h"
#include "alhazen/renderers/path_tracing/rough_lanes.h"
#include "alhazen/renderers/path_tracing/vertex_lanes.h"

namespace alhazen {

/// The state of a path; its next ray is in PathTracer::rays_.
struct EyePath {
    /// Not defaulted: that would zero the object first.
    EyePath() {}  // NOLINT(modernize-use-equals-default)

    // Read by VisibleBatch.
    RayKind kind = RayKind::Eye;
    bool inside = false;
    float time = 0;
    RayCone cone;

    std::uint32_t sample = 0;   ///< of the batch
    std::uint32_t met = 0;      ///< number of surfaces hit
    std::uint32_t stretch = 0;  ///< number of segments through scattering media
    int scatterings = 0;
    int drawn = 0;  ///< scatterings and straight passages: index of its random numbers
    Spectrum throughput{1, 1, 1, 1};
    double eta_scale = 1;  ///< removes the scaling of radiance by refraction for Russian roulette
    bool singular = true;  ///< the last scattering had no density: light was not sampled for it
    double density = 0;    ///< of the last scattering
    LitPoint from;         ///< point of the last scattering
    double travelled = 0;  ///< distance since the last scattering
    MediumStack media;
    FirstScattering first;  ///< only with layers of light
    ChainTrail trail;       ///< only with manifold search
};

class PathTracer {
  public:
    PathTracer(const RenderJob& job, std::size_t, RayCounters& counters, const Illumination& lights,
               const PathSettings& settings, LightLayers* layers,
               const ManifoldScene* manifold = nullptr);

    /// Writes the radiance of the samples. `rays`: through the centre of the lens.
    void trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                       std::span<Rgb> radiance);

  private:
    /// Direct light before occlusion, for layers and polarisation.
    struct JoinedLight {
        std::uint32_t sample;
        int scatterings;
        FirstScattering first;
        Spectrum light;
    };

    /// A surface point where a path scatters.
    struct Vertex {
        EyePath* path = nullptr;
        const ShadingPoint* point = nullptr;  ///< null if vertices wait for each other
        Vec3 place;
        ScatterPoint scatter;
        std::optional<LeavingRays> leaving;
    };

    /// A vertex in lanes.
    struct LaneVertex {
        EyePath* path = nullptr;
        const PlainMaterial* material = nullptr;
        const PlacedMesh* mesh = nullptr;
        std::uint32_t triangle = 0;  ///< of the mesh
        const Ray* ray = nullptr;
        double u = 0, v = 0;  ///< of the hit
    };

    void bounce(bool first);
    /// Puts the path into a lane if its vertex at the hit is plain; else false.
    [[nodiscard]] bool takes_into_lane(EyePath& path, const Ray& ray, const Hit& hit);
    /// Adds direct light at the vertices in lanes and scatters their paths.
    void scatter_lanes();
    /// Fills the lanes with their triangles, rays and materials.
    void fill_lanes();
    /// Draws the random numbers of the lanes.
    void draw_numbers();
    /// Adds the shadow ray of a lane that may pass beside its points.
    [[gnu::noinline]] void add_beside(std::size_t lane, const Ray& shadow, const Spectrum& shown);
    /// Sets the values and the sample of a BSDF that is neither matt nor a single rough reflection.
    void scatter_other(std::size_t lane);
    /// Continues a path along the direction of its lane.
    void leave_lane(std::size_t lane);
    /// Adds direct light at the waiting vertices and scatters their paths.
    void scatter_all();
    /// True if lights are sampled for the vertex; at the largest depth it is only passed straight.
    [[nodiscard]] bool is_lit(const Vertex& vertex) const {
        return vertex.scatter.has_density() && vertex.path->scatterings < settings_.depth;
    }
    /// The last vertex of the record (RenderJob::path); null for paths that are not recorded.
    [[nodiscard]] RecordedVertex* recorded(const EyePath& path) {
        return path.sample == recorded_ ? &job_.path->vertices.back() : nullptr;
    }
    void begin_record();
    void record_ray(const EyePath& path, const Ray& ray, const ShadingPoint* point, double t);
    void record_step(const EyePath& path, PathStep step) {
        if (RecordedVertex* vertex = recorded(path)) vertex->step = step;
    }
    /// Records a shadow ray; returns the sum that receives its light. Null if not recorded.
    [[nodiscard]] Spectrum* record_shadow(const EyePath& path, const Ray& shadow,
                                          const Spectrum& light);
    void record_arrival();
    /// Adds light at the end of a path to its sample.
    void add(const EyePath& path, const Spectrum& light, Spectrum& sum);
    /// True if direct light is summed apart from the sums of the samples.
    [[nodiscard]] bool joins_apart() const { return layers_ != nullptr || settings_.polarization; }
    void add_joined();
    /// Adds `to_eye` times `light`. `light`: that without polarisation; `to_eye`: the Stokes vector
    /// at the eye for unpolarised light 1.
    void add_polarized(std::uint32_t sample, int scatterings, const FirstScattering& first,
                       const Spectrum& light, const StokesLight& to_eye);
    /// The sum that receives direct light from `direction`; `scatter` null: scattered inside a
    /// volume.
    [[nodiscard]] Spectrum& place_of_joined(const EyePath& path, const FirstScattering& first,
                                            const ScatterPoint* scatter, const Vec3& direction,
                                            Spectrum& sum);
    /// Applies the limit to light of a shadow ray; polarised light is limited in `add_polarized`.
    [[nodiscard]] Spectrum limited_joined(const Spectrum& light, int scatterings) const {
        return settings_.polarization ? light : limited(light, scatterings);
    }
    /// Crosses the medium around a ray of length `t`. True if the path was scattered in it; it has
    /// then continued or ended.
    [[nodiscard]] bool cross_medium(EyePath& path, const Medium& medium, const Ray& ray, double t,
                                    Spectrum& sum);
    void scatter_in_volume(EyePath& path, const Medium& medium, const Ray& ray, Spectrum& sum);
    void escape(const EyePath& path, const Ray& ray, Spectrum& sum);
    /// Ends the paths of `escaped_`; the sky is looked up for several of them together.
    void escape_all();
    /// Adds the light of the environment to a path that leaves the scene.
    void add_far_light(const EyePath& path, const Illumination::FarLight& far, Spectrum& sum);
    /// Passes an uncovered part of the surface straight; false if the path ends there.
    [[nodiscard]] bool pass(EyePath& path, const ShadingPoint& point);
    /// `point`: reported by `visible_`.
    void meet(EyePath& path, const Ray& ray, const ShadingPoint& point, double t, Spectrum& sum);
    /// Adds emission and direct light at the surface where the path stops, and scatters the path.
    void stop(EyePath& path, const Ray& ray, const Hit& hit, const ShadingPoint& point,
              Spectrum& sum);
    void add_emission(const EyePath& path, const Ray& ray, const Hit& hit,
                      const ShadingPoint& point, Spectrum& sum);
    /// The random numbers of the choices at the next scattering (lobe, light); 0 unless `needed`.
    [[nodiscard]] Vec2 choices(const EyePath& path, bool needed) {
        return needed ? random_.draw(path.sample, path.drawn, PathRandomness::kChoices) : Vec2{};
    }
    void add_direct_light(const Vertex& vertex, const LightDraw& drawn, Spectrum& sum);
    /// Adds light by way of mirrors and glass, found by manifold search.
    void add_chains(const Vertex& vertex, Spectrum& sum);
    /// Continues the path along `drawn`; empty: the path is absorbed.
    void scatter(const Vertex& vertex, const std::optional<Scattered>& drawn);
    /// Sets `directions_`; diffuse directions are sampled together.
    void draw_directions(std::span<const Vertex> vertices);
    /// The kind of the first scattering, if the path is scattered along `direction` next.
    [[nodiscard]] FirstScattering first_along(const Vertex& vertex, const Vec3& direction) const;
    [[nodiscard]] bool survives_roulette(EyePath& path);
    /// Always inlined: the ray is made where it is kept. A copy would wait for its parts.
    [[gnu::always_inline]] void go_on(const EyePath& path, const Ray& ray) {
        ++next_kinds_[static_cast<std::size_t>(path.kind)];
        next_rays_[next_alive_.size()] = ray;
        next_alive_.push_back(path.sample);
    }
    /// The wavelengths of a sample; drawn on first use.
    [[nodiscard]] const Wavelengths& waves_of(std::uint32_t sample) {
        if (!random_.is_spectral()) return kColorChannels;
        Wavelengths& waves = waves_[sample];
        if (!waves.is_spectral()) waves = random_.waves(sample);
        return waves;
    }
    [[nodiscard]] const Wavelengths& waves(const EyePath& path) { return waves_of(path.sample); }
    /// Continues the path with the hero wavelength.
    void keep_hero(EyePath& path) {
        if (!random_.is_spectral()) return;
        static_cast<void>(waves(path));
        waves_[path.sample].keep_hero(path.throughput);
    }
    /// Applies PathSettings::clamp to light of a path of that many scatterings.
    [[nodiscard]] Spectrum limited(const Spectrum& light, int scatterings) const {
        const double limit = limit_of(light, scatterings);
        return limit < 1.0 ? limit * light : light;
    }
    [[nodiscard]] double limit_of(const Spectrum& light, int scatterings) const;

    const RenderJob& job_;
    const Scene& scene_;
    const Illumination& lights_;
    bool chooses_light_;  ///< Illumination::chooses
    DirectLightWeights weights_;
    PathSettings settings_;
    RayCounters& counters_;
    PathRandomness random_;
    CameraRays camera_;
    VisibleBatch visible_;
    ConnectionBatch shadows_;
    BsdfCache bsdfs_;
    ScatterPoint passed_;
    /// Vertices that wait for each other: their lights are sampled together.
    static constexpr std::size_t kMostWaiting = kMostMattDirections;
    std::array<Vertex, kMostWaiting> vertices_;
    std::size_t waiting_ = 0, most_waiting_;
    bool uses_lanes_;                     ///< plain vertices are handled in lanes
    bool escapes_later_;                  ///< paths wait in `escaped_`
    bool has_environment_;                ///< Illumination::has_environment
    std::vector<std::uint32_t> escaped_;  ///< [alive] that leave the scene
    PlainMeshes plain_;
    /// Bound of how far shadow rays of plain vertices pass beside their points, and of the rounding
    /// of their tests.
    double most_beside_;
    VertexLanes lanes_;
    RoughLanes rough_;
    std::array<LaneVertex, VertexLanes::kMost> of_lanes_;
    std::size_t in_lanes_ = 0;
    std::array<double, VertexLanes::kMost> lobe_choices_;  ///< set where a light is chosen, too
    LightDraws draws_;
    std::array<std::optional<Scattered>, kMostWaiting> directions_;  ///< [waiting vertex]
    MetFaces faces_;
    ShadingPoint other_face_;  ///< a coincident surface that is hit instead
    ScatteringMedia media_;
    MediumStack behind_;             ///< media behind the current surface
    LightLayers* layers_;            ///< null: no layers
    const ManifoldScene* manifold_;  ///< null: no manifold search
    std::optional<ManifoldLight> chains_;
    std::vector<LightParts> parts_;  ///< [sample of the batch]
    std::vector<JoinedLight> joined_;
    std::vector<StokesLight> joined_to_eye_;  ///< [joined]; only with polarisation
    std::vector<PolarizedPath> polarized_;    ///< [sample of the batch]; only with polarisation
    std::span<const SampleId> ids_;
    static constexpr std::uint32_t kNoSample = 0xFFFFFFFFu;
    std::uint32_t recorded_ = kNoSample;  ///< sample of the batch that is recorded
    Spectrum recorded_arrival_;
    std::vector<Wavelengths> waves_;  ///< [sample of the batch]; not spectral: not yet drawn
    std::vector<Spectrum> light_;     ///< [sample of the batch]
    std::vector<EyePath> paths_;      ///< [sample of the batch]
    std::vector<std::uint32_t> alive_, next_alive_;           ///< samples with an active path
    std::vector<Ray> rays_, next_rays_;                       ///< [alive]; as many as samples
    std::array<std::size_t, kRayKindCount> next_kinds_ = {};  ///< [kind] number of next rays
};

}  // namespace alhazen
