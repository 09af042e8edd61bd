#include "alhazen/renderers/distributed/distributed.h"

#include <algorithm>
#include <cmath>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/renderers/core/pixel_loop.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/whitted/recursive_estimator.h"
#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

enum Pair : std::uint32_t { kLensPair = 1, kTimePair = 2, kFirstBounce = 3 };
enum BouncePair : std::uint32_t { kReflectedLobe = 0, kRefractedLobe = 1, kFirstLight = 2 };

/// The exponent of the lobe of rays about a mirror direction, where normals have a lobe of `alpha`
/// (Blinn and Phong): a quarter of theirs.
double exponent_of(double alpha) {
    return 0.25 * (2.0 / (alpha * alpha) - 2.0);
}

/// A direction of the lobe cos^n about the unit `axis`.
Vec3 in_lobe(const Vec3& axis, double n, const Vec2& u) {
    const Vec2 p = on_unit_disc(u);
    const double share = p.x * p.x + p.y * p.y;  // uniform in 0 .. 1
    const double cosine = std::pow(1.0 - share, 1.0 / (n + 1.0));
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double scale = share > 0.0 ? sine / std::sqrt(share) : 0.0;
    const Vec3 a = perpendicular(axis), b = cross(axis, a);
    return normalize(cosine * axis + (scale * p.x) * a + (scale * p.y) * b);
}

/// Draws from the sampler of the round.
class SamplerChance {
  public:
    explicit SamplerChance(const RenderJob& job)
        : scene_(job.scene),
          sampler_(job.round->sampler),
          bounce_(static_cast<std::uint32_t>(job.scene.lights.size()) + kFirstLight) {}

    /// `ids`: of the eye rays from now on.
    void begin(std::span<const SampleId> ids) { ids_ = ids; }

    [[nodiscard]] Vec2 draw(std::uint32_t sample, std::uint32_t pair) const {
        return sampler_.at(ids_[sample].pixel, pair, ids_[sample].number);
    }
    [[nodiscard]] Vec2 draw(const Path& path, int depth, std::uint32_t pair) const {
        return draw(path.sample, kFirstBounce + static_cast<std::uint32_t>(depth) * bounce_ + pair);
    }

    [[nodiscard]] LightSample light_from(const Light& light, std::size_t number, const Vec3& point,
                                         bool clamp, const Path& path, int depth) const {
        const auto* area = std::get_if<AreaLight>(&light);
        if (area == nullptr) return sample(light, point, clamp);
        const auto pair = kFirstLight + static_cast<std::uint32_t>(number);
        return sample_extent(*area, point, draw(path, depth, pair));
    }

    /// Replaces an exact direction by one of the lobe of a rough material.
    void spread(RayKind kind, const ShadingPoint& point, const Path& path, int depth,
                Vec3& direction) const {
        const double roughness = roughness_at(point);
        if (!(roughness > 0.0)) return;
        const bool reflected = kind == RayKind::Reflection;
        const double n = exponent_of(roughness * roughness);
        const Vec3 drawn =
            in_lobe(direction, n, draw(path, depth, reflected ? kReflectedLobe : kRefractedLobe));
        // On the side of the surface that the exact direction is on.
        const double side = dot(direction, point.geometric), cosine = dot(drawn, point.geometric);
        direction = side * cosine < 0.0 ? drawn - (2.0 * cosine) * point.geometric : drawn;
    }

  private:
    /// Of a material of metallic-roughness; others are smooth.
    [[nodiscard]] double roughness_at(const ShadingPoint& point) const {
        if (!point.material->physical) return 0.0;
        const Surface& s = point.surface;
        const Material& m = scene_.materials[static_cast<std::size_t>(s.materials[0])];
        if (!m.metallic_roughness) return 0.0;
        const SurfaceLookup lookup{{s.uv, s.uv2}, {}, s.color};
        const double value = value_at(m.metallic_roughness->roughness, scene_.textures, lookup);
        return std::clamp(value, 0.0, 1.0);
    }

    const Scene& scene_;
    const Sampler& sampler_;
    std::uint32_t bounce_;  ///< pairs of one
    std::span<const SampleId> ids_;
};

class DistributedEstimator {
  public:
    DistributedEstimator(const RenderJob& job, std::size_t rays_at_once, RayCounters& counters)
        : tree_(job, rays_at_once, counters), lens_(job.camera) {}

    /// Of rays without samples: not called.
    void trace(std::span<const Ray> rays, std::span<Rgb> radiance) { tree_.trace(rays, radiance); }

    void trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                       std::span<Rgb> radiance) {
        tree_.chance().begin(ids);
        if (!lens_.open()) return tree_.trace(rays, radiance);
        through_lens_.clear();
        for (std::uint32_t i = 0; const Ray& ray : rays) {
            through_lens_.push_back(lens_.through(ray, tree_.chance().draw(i++, kLensPair)));
        }
        tree_.trace(through_lens_, radiance);
    }

  private:
    RecursiveEstimator<SamplerChance> tree_;
    LensRays lens_;
    std::vector<Ray> through_lens_;
};

static_assert(SampleEstimator<DistributedEstimator>);

constexpr std::size_t kSamplesAtOnce = 256;

}  // namespace

std::unique_ptr<TileRenderer> Distributed::begin(const RenderJob& job) const {
    if (job.round == nullptr) {
        return make_pixel_renderer<RecursiveEstimator<NoChance>>(job, kSamplesAtOnce);
    }
    return std::make_unique<RoundRenderer<DistributedEstimator>>(job, kSamplesAtOnce);
}

RenderReport Distributed::render(const RenderJob& job, Film& film) const {
    if (job.sampling != nullptr) return render_in_rounds(*this, job, film);
    const SamplingPlan plan;
    RenderJob sampled = job;
    sampled.sampling = &plan;
    return render_in_rounds(*this, sampled, film);
}

}  // namespace alhazen
