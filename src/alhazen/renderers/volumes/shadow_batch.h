#pragma once
/// Direct light at many points, by shadow rays that are gathered and cast together.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", 1980 (shadow rays); UW CSE
/// 457, Trace project (light through transparent surfaces).
/// Differs: if few rays hit anything, crossings are found for these only; if batches are no faster
/// than single rays, each ray is cast at once. ShadingConventions::ShadowTint defines the effect of
/// a crossing.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/core/material_cache.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/core/tinted_media.h"
#include "alhazen/renderers/core/wavefront.h"
#include "alhazen/renderers/volumes/coincident_faces.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

class ExactOptics;

class ShadowBatch {
  public:
    ShadowBatch(const Scene& scene, RayCounters& counters, TraversalStats* stats);

    /// Uses exact optics for all further rays; media are those of `Path::medium`.
    void use(ExactOptics& optics) { optics_ = &optics; }
    /// Media of `Path::medium` for all further rays, without exact optics.
    void use(const TintedMedia& media) { tinted_ = &media; }
    /// Adds transmittance * `light.intensity` * `fraction` to `sum`, now or in `finish`, in the
    /// order of the calls. `path`: that of the ray that hit `surface`, in the medium on the side of
    /// the light. `path` and `sum` must stay valid until `finish`. `number`: of the light in the
    /// scene, for coherent rays.
    void add(const LeavingRays& surface, const LightSample& light, const Rgb& fraction,
             const Path& path, Rgb& sum, std::size_t number = 0);
    /// Casts the gathered rays.
    void finish();
    /// Sets the coherence of further surfaces; no ray may be gathered. Coherent: the surfaces are
    /// neighbours; rays to the same light are cast together: they meet in a point or are parallel.
    void expect(Coherence coherence);

    /// True if batches are no faster than `arriving`, with which the reflected fraction need be
    /// computed only if light arrives.
    [[nodiscard]] bool casts_at_once() const { return at_once_; }
    /// Transmittance from the light to the surface, by a ray that is cast now.
    [[nodiscard]] Rgb arriving(const LeavingRays& surface, const LightSample& light,
                               const Path& path);

  private:
    struct Waiting {
        Rgb* sum = nullptr;
        const Path* path = nullptr;
        Rgb intensity, fraction;
        std::size_t light = 0;
    };

    [[nodiscard]] RayQuery query(float time = 0.0f) const {
        return {stats_, mask_of(RayKind::Shadow), time};
    }
    [[nodiscard]] std::span<const Ray> rays() const { return {rays_.get(), count_waiting_}; }
    [[nodiscard]] std::span<const Waiting> waiting() const {
        return {waiting_.get(), count_waiting_};
    }
    void find_met(std::span<bool> met);
    void find_met_by_light(std::span<bool> met);
    [[nodiscard]] bool asks_first() const;
    [[nodiscard]] Rgb let_through(const Ray& ray, const Path& path, bool met);
    /// Transmittance of the transparent surfaces in `crossings_` along `ray`.
    [[nodiscard]] Rgb tint_of_crossings(const Ray& ray, const Path& path);
    [[nodiscard]] Rgb tint_by_optics(const Ray& ray, const Path& path);
    /// The surface at a crossing. Valid until the next call.
    [[nodiscard]] const Surface& crossed(const Ray& ray, const Hit& hit, float time);
    /// The material of a surface. Valid until the next call.
    [[nodiscard]] const MaterialSample& material_of(const Surface& surface);

    const Scene& scene_;
    RayCount& count_;
    TraversalStats* stats_;
    ExactOptics* optics_ = nullptr;
    TintedMedia none_;
    const TintedMedia* tinted_ = &none_;
    bool opaque_;  ///< every surface blocks the light
    Coherence coherence_ = Coherence::Any;
    bool at_once_ = false;
    MaterialCache constant_;
    // Gathered rays.
    std::size_t count_waiting_ = 0;
    std::unique_ptr<Ray[]> rays_;
    std::unique_ptr<Waiting[]> waiting_;
    std::vector<float> times_;  ///< [ray]; where something moves
    std::unique_ptr<bool[]> met_;
    // Grouped by light, in the order in which rays were added.
    std::vector<std::uint32_t> begins_;  ///< [light] start of its rays in `sorted_`
    std::vector<std::uint32_t> places_;  ///< [ray] index in `sorted_`
    std::vector<Ray> sorted_;
    std::unique_ptr<bool[]> sorted_met_;
    std::vector<Hit> crossings_;
    Surface surface_;         ///< result of `crossed`
    MaterialSample own_;      ///< result of `material_of`
    MaterialSample medium_;   ///< between the surfaces of a solid of several media
    CrossedVolumes volumes_;  ///< around the shadow ray
    OtherFaces others_;       ///< faces that are crossed with a crossing
    CrossedFaces together_;   ///< with earlier crossings
};

}  // namespace alhazen
