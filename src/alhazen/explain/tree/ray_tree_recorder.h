#pragma once
/// Records the tree of rays while the estimator of recursive ray tracing computes it.
///
/// Conventions: a `Chance` of RecursiveEstimator (renderers/whitted/recursive_estimator.h) that
/// draws nothing and watches: rays and surfaces are those of the renderer `whitted`. The
/// transmittance of each shadow ray, which the renderer only adds up, is asked for again by the
/// same ShadowBatch, one ray at a time.
/// Threads: used by one.

#include <vector>

#include "alhazen/explain/tree/ray_tree.h"
#include "alhazen/renderers/core/shadow_batch.h"
#include "alhazen/renderers/whitted/recursive_estimator.h"

namespace alhazen {

class RayTreeRecorder : public NoChance {
  public:
    explicit RayTreeRecorder(const RenderJob& job);

    // ---- called by the estimator (TreeWatcher)
    void use(ExactOptics& optics) { shadows_.use(optics); }
    void begin_rays(const GenerationPart& part, int depth);
    void see_light(std::size_t number, const LightSample& light, double cosine);
    void meet(const ShadingPoint& point, double t, const Path& path, int depth,
              const MetSurface& met);
    void miss(std::uint32_t ray, const Rgb& left, int depth);
    void gather(const Wavefront& front, int depth);
    void end_rays(const GenerationPart& part, int depth);

    /// The rays of the last call of `trace`; leaves none behind.
    [[nodiscard]] std::vector<RayNode> take();

  private:
    /// The rays of the generation that is being traced, and the surfaces of those that wait.
    struct Level {
        std::vector<RayNode> rays;
        std::size_t base = 0;  ///< of the part that is being traced
        std::vector<SurfaceNode> met;
    };
    /// A light of the surface that is being shaded.
    struct SeenLight {
        std::size_t number;
        LightSample light;
        double cosine;
    };

    Level& level(int depth);
    [[nodiscard]] LightTerm term_of(const SeenLight& seen, const ShadingPoint& point,
                                    const Path& path);
    void list_crossings(LightTerm& term) const;
    void set_ambient(const ShadingPoint& point, SurfaceNode& node);
    void set_reasons(const ShadingPoint& point, const Path& path, int depth, const MetSurface& met,
                     SurfaceNode& node) const;

    const Scene& scene_;
    const ShadingConventions& conventions_;
    RayCounters counters_;  ///< of the repeated shadow rays; not used
    ShadowBatch shadows_;
    std::vector<Rgb> ambient_;
    ShadingPoint bare_;  ///< a point with one term left
    std::vector<SeenLight> seen_;
    std::vector<Level> levels_;
};

}  // namespace alhazen
