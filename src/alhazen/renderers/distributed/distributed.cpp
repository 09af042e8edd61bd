#include "alhazen/renderers/distributed/distributed.h"

#include <algorithm>
#include <cmath>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/renderers/core/rough_lobe.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_draws.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/whitted/recursive_estimator.h"
#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {

namespace {

enum Pair : std::uint32_t { kLensPair = 1, kTimePair = 2, kFirstBouncePair = 3 };
enum BouncePair : std::uint32_t { kReflectedLobe = 0, kRefractedLobe = 1, kFirstLight = 2 };

/// Random choices of the recursion, from the sampler of the round.
class SamplerRandomness {
  public:
    explicit SamplerRandomness(const RenderJob& job)
        : moves_(job.scene.has_motion || job.camera_motion != nullptr),
          bounce_(static_cast<std::uint32_t>(job.scene.lights.size()) + kFirstLight),
          draws_(job.round->sampler, std::min(kFirstBouncePair + bounce_, kMostTogether)) {}

    /// `ids`: of the following eye rays.
    void begin(std::span<const SampleId> ids) { draws_.begin(ids); }

    [[nodiscard]] Vec2 draw(std::uint32_t sample, std::uint32_t pair) {
        return draws_.at(sample, pair);
    }
    [[nodiscard]] Vec2 draw(const Path& path, int depth, std::uint32_t pair) {
        return draw(path.sample,
                    kFirstBouncePair + static_cast<std::uint32_t>(depth) * bounce_ + pair);
    }

    /// Sampled only if something moves.
    [[nodiscard]] float time(std::uint32_t sample) {
        if (!moves_) return 0.0f;
        // Clamped below 1, to which the double may be rounded.
        return std::min(static_cast<float>(draw(sample, kTimePair).x), 0x1.fffffep-1f);
    }

    [[nodiscard]] LightSample light_from(const Light& light, std::size_t number, const Vec3& point,
                                         bool clamp, const Path& path, int depth) {
        const auto* area = std::get_if<AreaLight>(&light);
        if (area == nullptr) return sample(light, point, clamp);
        const auto pair = kFirstLight + static_cast<std::uint32_t>(number);
        return sample_extent(*area, point, draw(path, depth, pair));
    }

    /// Replaces an exact direction by a sample of the lobe of a rough material.
    void spread(RayKind kind, const ShadingPoint& point, const Path& path, int depth,
                Vec3& direction) {
        const double roughness = point.material->roughness;
        if (!(roughness > 0.0)) return;
        const bool reflected = kind == RayKind::Reflection;
        const double n = lobe_exponent(roughness);
        const Vec3 drawn =
            in_lobe(direction, n, draw(path, depth, reflected ? kReflectedLobe : kRefractedLobe));
        // Mirrors the sample to the side of the surface on which the exact direction lies.
        const double side = dot(direction, point.geometric), cosine = dot(drawn, point.geometric);
        direction = side * cosine < 0.0 ? drawn - (2.0 * cosine) * point.geometric : drawn;
    }

  private:
    /// Bounds the memory for scenes with many lights: 4 KiB per pair.
    static constexpr std::uint32_t kMostTogether = 4096;

    bool moves_;
    std::uint32_t bounce_;  ///< pairs per bounce
    SampleDraws draws_;     ///< caches the pairs up to the first bounce, which most samples use
};

class DistributedEstimator {
  public:
    DistributedEstimator(const RenderJob& job, std::size_t rays_at_once, RayCounters& counters)
        : tree_(job, rays_at_once, counters), lens_(job.camera), motion_(job.camera_motion) {
        if (motion_ != nullptr) camera_from_world_ = motion_->at(0.0).inner_from_outer;
    }

    /// Required by the estimator concept for rays without samples; not called.
    void trace(std::span<const Ray> rays, std::span<Rgb> radiance) { tree_.trace(rays, radiance); }

    void trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                       std::span<Rgb> radiance) {
        tree_.randomness().begin(ids);
        if (!lens_.open() && motion_ == nullptr) return tree_.trace(rays, radiance);
        drawn_.clear();
        for (std::uint32_t i = 0; const Ray& ray : rays) {
            drawn_.push_back(
                lens_.open() ? lens_.through(ray, tree_.randomness().draw(i, kLensPair)) : ray);
            if (motion_ != nullptr) carry(tree_.randomness().time(i), drawn_.back());
            ++i;
        }
        tree_.trace(drawn_, radiance);
    }

  private:
    /// Moves a ray to the camera's pose at `time`.
    void carry(double time, Ray& ray) const {
        const Affine moved = motion_->at(time).outer_from_inner * camera_from_world_;
        ray = transformed(moved, ray);
        ray.direction = normalize(ray.direction);
    }

    RecursiveEstimator<SamplerRandomness> tree_;
    LensRays lens_;
    const TransformMotion* motion_;
    Affine camera_from_world_;  ///< at shutter open
    std::vector<Ray> drawn_;
};

static_assert(SampleEstimator<DistributedEstimator>);

constexpr std::size_t kSamplesAtOnce = 256;

/// Renders tiles of a job without a round: all samples, by the default sampler and filter.
class OneRound final : public TileRenderer {
  public:
    explicit OneRound(const RenderJob& job)
        : sampler_(plan_.sampler->make(job.seed, count(job))),
          filter_(*plan_.filter, plan_.radius),
          round_{*sampler_, filter_, 0, count(job), {}, {}},
          job_(with_round(job, round_)),
          tiles_(job_, kSamplesAtOnce) {}

    void render(const PixelBox& tile, Film& film, RayCounters& counters) override {
        tiles_.render(tile, film, counters);
    }

  private:
    static std::uint32_t count(const RenderJob& job) {
        return static_cast<std::uint32_t>(job.samples_per_pixel);
    }
    static RenderJob with_round(const RenderJob& job, const SampleRound& round) {
        RenderJob sampled = job;
        sampled.round = &round;
        return sampled;
    }

    SamplingPlan plan_;
    std::unique_ptr<Sampler> sampler_;
    FilterKernel filter_;
    SampleRound round_;
    RenderJob job_;
    RoundRenderer<DistributedEstimator> tiles_;
};

}  // namespace

std::unique_ptr<TileRenderer> Distributed::begin(const RenderJob& job) const {
    if (job.round == nullptr) return std::make_unique<OneRound>(job);
    return std::make_unique<RoundRenderer<DistributedEstimator>>(job, kSamplesAtOnce);
}

RenderReport Distributed::render(const RenderJob& job, Film& film) const {
    return render_in_rounds(*this, with_plan(job), film);
}

}  // namespace alhazen
