#pragma once
/// Connects the eye and light subpaths of samples, every vertex of one to every vertex of the
/// other.

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/bidirectional/path_weight.h"
#include "alhazen/renderers/light_transport/camera_lens.h"
#include "alhazen/renderers/light_transport/camera_rays.h"
#include "alhazen/renderers/light_transport/connection_batch.h"
#include "alhazen/renderers/light_transport/light_starts.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/renderers/light_transport/power_heuristic.h"
#include "alhazen/renderers/light_transport/random_walk.h"
#include "alhazen/renderers/light_transport/splat_film.h"

namespace alhazen {

/// Contributions of light paths to the lens, of all tiles.
struct LensLight {
    SplatFilm splats;
    std::atomic<std::uint64_t> paths{0};
};

class BidirectionalTracer {
  public:
    BidirectionalTracer(const RenderJob& job, std::size_t, RayCounters& counters,
                        const Illumination& lights, const PathSettings& settings,
                        LensLight* lens_light);
    virtual ~BidirectionalTracer() = default;
    BidirectionalTracer(const BidirectionalTracer&) = delete;
    BidirectionalTracer& operator=(const BidirectionalTracer&) = delete;

    /// `rays`: eye rays through the centre of the lens.
    void trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                       std::span<Rgb> radiance);

  protected:
    /// Adds the contributions of further strategies for the eye's path; `merging` of their paths is
    /// that of WholePath.
    virtual void merge(Spectrum& /*sum*/) {}
    void set_merging(double merging) { path_.merging = merging; }
    /// Sets the wavelengths of all samples; null: each sample has its own.
    void set_waves(const Wavelengths* waves) { all_waves_ = waves; }
    [[nodiscard]] const std::vector<PathVertex>& eye_path() const { return eye_; }
    [[nodiscard]] const PathSettings& settings() const { return settings_; }

  private:
    /// The light at which the light path began, or that was sampled.
    struct LightEnd {
        Illumination::LightPoint place;
        Illumination::EmitDensity emit;
    };

    /// The radiance of the sample's eye path.
    [[nodiscard]] Spectrum trace(const SampleId& id, const Ray& ray);
    /// Adds emission at the last eye vertex, or of the environment behind it.
    void hit_light(std::size_t b, Spectrum& sum);
    void hit_environment(Spectrum& sum);
    /// Connects eye vertex b - 1 to a light sampled for it.
    void join_light(const SampleId& id, std::size_t b, float time, Spectrum& sum);
    /// Connects light vertex a - 1 and eye vertex b - 1.
    void join(std::size_t a, std::size_t b, float time, Spectrum& sum);
    /// Connects light vertex a - 1 to the lens.
    void join_lens(const SampleId& id, std::size_t a, float time);

    /// Sets the densities, from both sides, of the eye vertices 0 .. b - 3 as the last ones of
    /// `path_`, and those of the light vertices 0 .. a - 3 as the first.
    void begin_path(std::size_t a, std::size_t b);
    [[nodiscard]] WholePath::Vertex& of_light(std::size_t i) { return path_.vertices[i + 1]; }
    [[nodiscard]] WholePath::Vertex& of_eye(std::size_t i) {
        return path_.vertices[path_.vertices.size() - 1 - i];
    }
    /// Vertex 1 of a path, with the densities between it and the light.
    struct LitVertex {
        const PathVertex& v;
        Vec3 to_light;
        double distance;
        double eye_density;  ///< density by solid angle of the eye's path continuing to the light
        double reached;      ///< shares of walks in both directions that arrive (PathVertex)
        double backward;
    };
    /// Sets vertex 0, and the densities of a light path at vertex 1.
    void set_light(const LightEnd& end, const LitVertex& lit);
    /// The same for a path whose first vertex is that of `light_`.
    void set_light_of_path(double eye_density);
    /// True if light that hits find at vertex 1 of `path_`, which is set up to `joined`, is left to
    /// the strategies that connect.
    [[nodiscard]] bool is_only_joined() const {
        return weights_.shadow_rays_alone() && path_.joined > 0.0 && !path_.vertices[1].singular;
    }

    const RenderJob& job_;
    const Scene& scene_;
    const Illumination& lights_;
    DirectLightWeights weights_;
    PathSettings settings_;
    RayCounters& counters_;
    TraversalStats* stats_;
    PathRandomness random_;
    CameraRays camera_;
    CameraLens lens_;
    LightStarts starts_;
    RandomWalk walk_;
    ConnectionBatch joins_;
    LensLight& lens_light_;
    std::vector<PathVertex> eye_, light_;
    MediumStack behind_;  ///< at the current surface
    RandomWalk::Escape escape_;
    LightEnd begin_;  ///< the light of `light_`
    const Wavelengths* all_waves_ = nullptr;
    Wavelengths waves_;  ///< wavelengths of the sample, at the start of both paths
    WholePath path_;
};

}  // namespace alhazen
