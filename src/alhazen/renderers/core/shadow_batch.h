#pragma once
/// Light on its way to many points: shadow rays are gathered, then cast together.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", 1980 (shadow rays); UW CSE
/// 457, Trace project (light through transparent surfaces). Differs: where few rays meet
/// anything, only those are asked what they meet; what that does is as
/// ShadingConventions::ShadowTint says.

#include <memory>
#include <span>
#include <vector>

#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/core/wavefront.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

class ShadowBatch {
  public:
    ShadowBatch(const Scene& scene, RayCounters& counters, TraversalStats* stats);

    /// Light from `surface` towards a light: adds to `sum`, now or by `finish`, what arrives of
    /// `light.intensity` times the `fraction` that is reflected. Sums are added to in the order of
    /// the calls. `path`: that of the ray that met the surface. Both must stay where they are.
    void add(const Surface& surface, const LightSample& light, const Rgb& fraction,
             const Path& path, Rgb& sum);
    /// Casts what has been gathered.
    void finish(Coherence coherence = Coherence::Any);

  private:
    struct Waiting {
        Rgb* sum;
        const Path* path;
        Rgb intensity, fraction;
    };

    [[nodiscard]] RayQuery query() const { return {stats_, mask_of(RayKind::Shadow)}; }
    [[nodiscard]] bool asks_first() const;
    [[nodiscard]] Rgb let_through(const Ray& ray, const Path& path, bool met);
    /// What the transparent surfaces in `crossings_` leave of light along `ray`.
    [[nodiscard]] Rgb tint_of_crossings(const Ray& ray, const Path& path);
    [[nodiscard]] Rgb light_through(const MaterialSample& material, const MaterialSample& medium,
                                    bool leaving, double inside) const;
    [[nodiscard]] Rgb through_medium(double distance) const;
    void enter_or_leave(bool leaving, const Rgb& absorption);

    const Scene& scene_;
    RayCount& count_;
    TraversalStats* stats_;
    bool opaque_;  ///< whatever is in between ends the light
    std::vector<Ray> rays_;
    std::vector<Waiting> waiting_;
    std::unique_ptr<bool[]> met_;
    std::vector<Hit> crossings_;
    std::vector<Rgb> media_;  ///< absorption of the volumes that a shadow ray is inside of
};

}  // namespace alhazen
