#include "alhazen/renderers/ambient_occlusion/ambient_occlusion.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/core/visible_batch.h"
#include "alhazen/renderers/core/wavefront.h"
#include "alhazen/renderers/light_transport/camera_rays.h"
#include "alhazen/renderers/light_transport/connection_batch.h"
#include "alhazen/renderers/light_transport/shading_frame.h"

namespace alhazen {

namespace {

constexpr std::size_t kPointsAtOnce = 1024;

/// Default distance relative to the scene's diagonal: large enough for the corners of rooms to be
/// dark.
constexpr double kShareOfDiagonal = 0.25;

double reach_of(const OcclusionSettings& settings, const Scene& scene) {
    if (settings.distance > 0.0) return settings.distance;
    const double diagonal = kShareOfDiagonal * length(scene.aggregate->box().size());
    return std::isfinite(diagonal) && diagonal > 0.0 ? diagonal
                                                     : std::numeric_limits<double>::infinity();
}

/// Samples a cosine-weighted direction around z.
Vec3 on_hemisphere(const Vec2& u) {
    const Vec2 p = on_unit_disc(u);
    return {p.x, p.y, std::sqrt(std::fmax(0.0, 1.0 - p.x * p.x - p.y * p.y))};
}

class OcclusionEstimator {
  public:
    OcclusionEstimator(const RenderJob& job, std::size_t, RayCounters& counters,
                       const OcclusionSettings& settings)
        : job_(job),
          settings_(settings),
          reach_(reach_of(settings, job.scene)),
          counters_(counters),
          random_(job),
          camera_(job),
          visible_(job.scene, job.count_tests ? &counters.tests : nullptr),
          shadows_(job.scene, counters, job.count_tests ? &counters.tests : nullptr,
                   mask_of(RayKind::Shadow)) {}

    void trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                       std::span<Rgb> radiance) {
        paths_.clear();
        rays_.clear();
        light_.assign(rays.size(), {});
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Path& path = paths_.emplace_back();
            path.time = camera_.time(random_, ids[i]);
            path.cone = job_.cone;
            rays_.push_back(camera_.through_lens(random_, ids[i], rays[i], path.time));
        }
        counters_[RayKind::Eye].cast += rays.size();
        visible_.find(
            rays_, Coherence::Coherent, [&](std::size_t k) -> const Path& { return paths_[k]; },
            [&](std::size_t k, const ShadingPoint* point, double) {
                if (point == nullptr) {
                    radiance[k] = job_.scene.background;
                    return;
                }
                ++counters_[RayKind::Eye].hit;
                look_around(*point, ids[k], paths_[k].time, light_[k]);
            });
        shadows_.finish();
        for (std::size_t i = 0; i < rays.size(); ++i)
            radiance[i] += kColorChannels.color(light_[i]);
    }

  private:
    void look_around(const ShadingPoint& point, const SampleId& id, float time, Spectrum& sum) {
        const ShadingFrame frame = ShadingFrame::of(point.normal, {});
        const Vec3 direction =
            frame.to_world(on_hemisphere(random_.draw(id, 0, PathRandomness::kDirection)));
        if (!(dot(direction, point.geometric) > 0.0)) return;
        const Rgb color = settings_.albedo ? point.material->albedo : Rgb{1, 1, 1};
        shadows_.add(leaving_ray(point.surface, direction, reach_), time, {}, kColorChannels,
                     kColorChannels.reflectance(color), sum);
    }

    const RenderJob& job_;
    OcclusionSettings settings_;
    double reach_;
    RayCounters& counters_;
    PathRandomness random_;
    CameraRays camera_;
    VisibleBatch visible_;
    ConnectionBatch shadows_;
    std::vector<Path> paths_;
    std::vector<Ray> rays_;
    std::vector<Spectrum> light_;  ///< [ray]
};

class OcclusionTiles final : public TiledRenderer {
  public:
    explicit OcclusionTiles(const OcclusionSettings& settings) : settings_(settings) {}

    [[nodiscard]] std::unique_ptr<TileRenderer> begin(const RenderJob& job) const override {
        return std::make_unique<RoundRenderer<OcclusionEstimator>>(job, kPointsAtOnce, settings_);
    }

  private:
    OcclusionSettings settings_;
};

}  // namespace

RenderReport AmbientOcclusion::render(const RenderJob& job, Film& film) const {
    return render_in_rounds(OcclusionTiles(settings_), with_plan(job), film);
}

}  // namespace alhazen
