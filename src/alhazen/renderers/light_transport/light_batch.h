#pragma once
/// Light that may be blocked: connections between points are gathered, then cast together.
///
/// Conventions: alpha coverage and thin sheets let light through, tinted; what bends light blocks
/// it, for a straight connection does not exist there. Where volumes scatter, boundaries that do
/// not bend it let it into the next volume; so do the openings of those that cover in part.
/// Single-sided surfaces block from both sides; the eye alone does not see their backs.

#include <memory>
#include <span>
#include <vector>

#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/light_transport/coincident_faces.h"
#include "alhazen/renderers/light_transport/free_flight.h"
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
    /// `media`: around its beginning; `waves` stays until `finish`. Sums are added to in the order
    /// of the calls.
    void add(const Ray& ray, float time, const MediumStack& media, const Wavelengths& waves,
             const Spectrum& light, Spectrum& sum);
    /// Casts the gathered rays.
    void finish();

    /// The share that passes along one ray. `flight`: that of a walk there; null: it is not asked.
    [[nodiscard]] Spectrum passing(const Ray& ray, float time, const MediumStack& media,
                                   const Wavelengths& waves, FreeFlight* flight = nullptr);
    /// The same along a ray from the eye.
    [[nodiscard]] Spectrum seen(const Ray& from_eye, float time, const MediumStack& media,
                                const Wavelengths& waves, FreeFlight* flight = nullptr);

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
    /// Finds what a ray passes; false: something blocks it.
    [[nodiscard]] bool find_crossings(const Ray& ray, float time, RayKind kind);
    /// Of a ray that meets something.
    [[nodiscard]] Spectrum through_surfaces(const Ray& ray, float time, RayKind kind,
                                            const Wavelengths& waves);
    /// What the volumes on its way leave, too. `met`: whether it meets something.
    [[nodiscard]] Spectrum through_volumes(const Ray& ray, float time, RayKind kind,
                                           const MediumStack& media, const Wavelengths& waves,
                                           bool met, FreeFlight* flight);
    /// `media`: those before it, then those behind; null: it cannot lie between volumes.
    [[nodiscard]] Spectrum through(const Ray& ray, float time, RayKind kind, const Hit& crossing,
                                   const Wavelengths& waves, MediumStack* media);
    /// Takes the face of that hit from those that have been crossed, if it is one of them.
    [[nodiscard]] bool take_crossed(const Hit& hit);
    [[nodiscard]] Spectrum passing(const Ray& ray, float time, RayKind kind,
                                   const MediumStack& media, const Wavelengths& waves,
                                   FreeFlight* flight);

    const Scene& scene_;
    RayCount& count_;
    TraversalStats* stats_;
    ScatteringMedia media_;
    CoincidentFaces faces_;
    bool has_single_sided_;
    std::vector<Ray> rays_;
    std::vector<Waiting> waiting_;
    std::vector<float> times_;
    std::vector<MediumStack> around_;  ///< [ray]; where volumes are followed
    std::unique_ptr<bool[]> met_;
    std::vector<Hit> crossings_;
    OtherFaces crossed_;  ///< that coincide with the last crossing, and need not be crossed again
};

}  // namespace alhazen
