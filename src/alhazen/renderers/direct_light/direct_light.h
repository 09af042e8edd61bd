#pragma once
/// Direct light at many points where no surface lets light through: shadow rays are made in lanes
/// and cast together, those of one light after those of another.
///
/// Conventions: the bits of `reflected_fraction` and of one shadow ray after the other
/// (volumes/shadow_batch.h). Threads: used by one thread.

#include <cstddef>
#include <memory>
#include <vector>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/direct_light/light_rays.h"

namespace alhazen {

class DirectLight {
  public:
    /// True if shadow rays of the scene end at whatever they meet, and nothing moves.
    [[nodiscard]] static bool covers(const Scene& scene);

    /// The scene must outlive the object, and be covered.
    DirectLight(const Scene& scene, RayCounters& counters, TraversalStats* stats);

    /// Adds the light at the point to `sum`, now or in `finish`, in the order of the lights. `sum`
    /// must stay valid until then.
    void add(const ShadingPoint& point, Rgb& sum) {
        if (count_ == ShadedPoints::kMost) finish();
        const std::size_t i = count_++;
        const MaterialSample& material = *point.material;
        for (int k = 0; k < 3; ++k) {
            points_->point[k][i] = point.surface.point[k];
            points_->normal[k][i] = point.normal[k];
            points_->view[k][i] = point.view[k];
            points_->outward[k][i] = point.surface.normal[k];
            points_->diffuse[k][i] = material.diffuse[k];
        }
        points_->margin[i] = LeavingRays::margin(point.surface);
        sums_[i] = &sum;
        const std::size_t bit = i % ShadedPoints::kStep;
        std::uint16_t& shiny = points_->shiny[i / ShadedPoints::kStep];
        if (bit == 0) shiny = 0;
        if (material.specular.is_black()) return;
        shiny = static_cast<std::uint16_t>(shiny | (1u << bit));
        gloss_[i] = gloss_of(point);
    }
    /// Casts the shadow rays.
    void finish();
    /// Sets the coherence of further points; none may be waiting. Coherent: they are neighbours.
    void expect(Coherence coherence) { coherence_ = coherence; }

  private:
    struct LitBy {
        const Light* light = nullptr;
        bool glints = true;  ///< LightSample::glints
    };

    /// The number in `glosses_` of the material of a point.
    [[nodiscard]] std::size_t gloss_of(const ShadingPoint& point);
    void add_light_of(const LitBy& by);
    [[nodiscard]] Rgb reflected(const LitBy& by, std::size_t point) const;

    const Scene& scene_;
    RayCount& cast_;
    TraversalStats* stats_;
    std::vector<LitBy> lights_;  ///< those that illuminate
    Coherence coherence_ = Coherence::Any;
    std::size_t count_ = 0;  ///< of points
    std::unique_ptr<ShadedPoints> points_;
    std::unique_ptr<LightRays> rays_;
    std::unique_ptr<Rgb*[]> sums_;          ///< [point]
    std::unique_ptr<std::size_t[]> gloss_;  ///< [point] that has highlights
    std::vector<MaterialSample> glosses_;
    MaterialId last_{};            ///< if `last_is_shared_`: the material of the last of `glosses_`
    bool last_is_shared_ = false;  ///< the last of `glosses_` is that of all points of `last_`
    std::unique_ptr<bool[]> met_;  ///< [ray]
};

}  // namespace alhazen
