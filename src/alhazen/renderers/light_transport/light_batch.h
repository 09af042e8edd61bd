#pragma once
/// Light that may be blocked: connections between points are gathered, then cast together.
///
/// Conventions: alpha coverage and thin sheets let light through, tinted; what bends light blocks
/// it, for a straight connection does not exist there. Single-sided surfaces block from both sides;
/// the eye alone does not see their backs.

#include <memory>
#include <span>
#include <vector>

#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/light_transport/scattering_media.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// Of the distance between two points: where a ray from one to the other ends, so that what holds
/// the other does not block it.
inline constexpr double kBeforeEnd = 1.0 - 1e-7;

class LightBatch {
  public:
    LightBatch(const Scene& scene, RayCounters& counters, TraversalStats* stats);

    /// Adds `light` to `sum`, now or in `finish`, times what passes along `ray` up to its t_max;
    /// `extinction`: of the medium in between; `waves` stays until `finish`. Sums are added to in
    /// the order of the calls.
    void add(const Ray& ray, float time, const Extinction& extinction, const Wavelengths& waves,
             const Spectrum& light, Spectrum& sum);
    /// Casts the gathered rays.
    void finish();

    /// The share that passes along one ray.
    [[nodiscard]] Spectrum passing(const Ray& ray, float time, const Extinction& extinction,
                                   const Wavelengths& waves);
    /// The same along a ray from the eye.
    [[nodiscard]] Spectrum seen(const Ray& from_eye, float time, const Extinction& extinction,
                                const Wavelengths& waves);

  private:
    struct Waiting {
        Spectrum light;
        const Wavelengths* waves;
        Spectrum* sum;
    };

    [[nodiscard]] RayQuery query(float time, RayKind kind = RayKind::Shadow) const {
        return {stats_, mask_of(kind), time};
    }
    void find_met(std::span<bool> met);
    /// Of a ray that meets something.
    [[nodiscard]] Spectrum through_surfaces(const Ray& ray, float time, RayKind kind,
                                            const Wavelengths& waves);
    [[nodiscard]] Spectrum through(const Ray& ray, float time, RayKind kind, const Hit& crossing,
                                   const Wavelengths& waves) const;
    [[nodiscard]] Spectrum passing(const Ray& ray, float time, RayKind kind,
                                   const Extinction& extinction, const Wavelengths& waves);

    const Scene& scene_;
    RayCount& count_;
    TraversalStats* stats_;
    bool has_single_sided_;
    std::vector<Ray> rays_;
    std::vector<Waiting> waiting_;
    std::vector<float> times_;
    std::unique_ptr<bool[]> met_;
    std::vector<Hit> crossings_;
};

}  // namespace alhazen
