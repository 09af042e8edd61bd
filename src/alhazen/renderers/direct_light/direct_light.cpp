#include "alhazen/renderers/direct_light/direct_light.h"

namespace alhazen {

namespace {

/// Copies the last number of each row behind it, up to a whole step.
template <std::size_t N>
void fill_step(double (&row)[N], std::size_t count) {
    for (std::size_t i = count; i % ShadedPoints::kStep != 0; ++i) row[i] = row[count - 1];
}
template <std::size_t N>
void fill_step(double (&rows)[3][N], std::size_t count) {
    for (auto& row : rows) fill_step(row, count);
}

bool glints(const Light& light) {
    return std::visit(
        [](const auto& l) {
            if constexpr (requires { l.glints; }) return l.glints;
            return true;
        },
        light);
}

}  // namespace

bool DirectLight::covers(const Scene& scene) {
    return !scene.has_motion && scene.all_block_light() &&
           scene.conventions.shading.shadow_tint != ShadingConventions::ShadowTint::None;
}

DirectLight::DirectLight(const Scene& scene, RayCounters& counters, TraversalStats* stats)
    : scene_(scene),
      cast_(counters[RayKind::Shadow]),
      stats_(stats),
      points_(std::make_unique<ShadedPoints>()),
      rays_(std::make_unique<LightRays>()),
      sums_(std::make_unique<Rgb*[]>(ShadedPoints::kMost)),
      gloss_(std::make_unique<std::size_t[]>(ShadedPoints::kMost)),
      met_(std::make_unique<bool[]>(LightRays::kMost)) {
    for (const Light& light : scene.lights) {
        if (illuminates(light)) lights_.push_back({&light, glints(light)});
    }
}

std::size_t DirectLight::gloss_of(const ShadingPoint& point) {
    const bool shared = point.material != &point.own;
    const MaterialId id = point.surface.materials[0];
    const bool known = shared && last_is_shared_ && id == last_ && !glosses_.empty();
    if (!known) {
        glosses_.push_back(*point.material);
        last_ = id;
        last_is_shared_ = shared;
    }
    return glosses_.size() - 1;
}

void DirectLight::finish() {
    if (count_ == 0) return;
    ShadedPoints& points = *points_;
    for (auto* rows :
         {&points.point, &points.normal, &points.view, &points.outward, &points.diffuse}) {
        fill_step(*rows, count_);
    }
    fill_step(points.margin, count_);
    for (const LitBy& light : lights_) add_light_of(light);
    count_ = 0;
    glosses_.clear();
}

void DirectLight::add_light_of(const LitBy& by) {
    const std::size_t count =
        aim_at_light(scene_.conventions.shading, *by.light, count_, *points_, *rays_);
    if (count == 0) return;
    const std::span<bool> met(met_.get(), count);
    scene_.aggregate->occluded_batch({rays_->rays, count}, met, {stats_, mask_of(RayKind::Shadow)},
                                     coherence_);
    cast_.cast += count;
    for (std::size_t i = 0; i < count; ++i) {
        if (met[i]) {
            ++cast_.hit;
            continue;
        }
        const std::size_t at = rays_->of[i];
        *sums_[at] += reflected(by, at);
    }
}

Rgb DirectLight::reflected(const LitBy& by, std::size_t point) const {
    const LightRays& rays = *rays_;
    const std::uint32_t shiny = points_->shiny[point / ShadedPoints::kStep];
    if ((shiny >> (point % ShadedPoints::kStep) & 1u) == 0) {
        return {rays.matt[0][point], rays.matt[1][point], rays.matt[2][point]};
    }
    const MaterialSample& m = glosses_[gloss_[point]];
    const Rgb intensity{rays.intensity[0][point], rays.intensity[1][point],
                        rays.intensity[2][point]};
    const double cosine = rays.cosine[point];
    Rgb fraction = cosine * m.diffuse;
    if (by.glints || m.transmissive.is_black()) {
        fraction =
            with_highlight(scene_.conventions.shading, m, rays.highlight[point], cosine, fraction);
    }
    return intensity * fraction;
}

}  // namespace alhazen
