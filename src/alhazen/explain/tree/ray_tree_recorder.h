#pragma once
/// Records the tree of rays while the estimator of Whitted ray tracing computes it.
///
/// Conventions: a `Randomness` of RecursiveEstimator (renderers/whitted/recursive_estimator.h) that
/// draws nothing and only observes: rays and surfaces are those of the renderer `whitted`. The
/// transmittance of each shadow ray, of which the renderer keeps only sums, is computed again by
/// the same ShadowBatch, one ray at a time. A tree of too many rays, or a stop by the user, ends
/// the estimator through the stop flag of its job; the recorded tree is then incomplete.
/// Threads: used by one thread.

#include <cstddef>
#include <vector>

#include "alhazen/explain/tree/ray_tree.h"
#include "alhazen/renderers/volumes/shadow_batch.h"
#include "alhazen/renderers/whitted/recursive_estimator.h"

namespace alhazen {

class RayTreeRecorder : public NoRandomness {
  public:
    explicit RayTreeRecorder(const RenderJob& job);

    // ---- Called by the estimator (TreeWatcher).
    void use(ExactOptics& optics) { shadows_.use(optics); }
    void use(const TintedMedia& media) { shadows_.use(media); }
    void begin_rays(const GenerationPart& part, int depth);
    void see_light(std::size_t number, const LightSample& light, double cosine);
    void meet(const ShadingPoint& point, double t, const Path& path, int depth,
              const MetSurface& met);
    void miss(std::uint32_t ray, const Rgb& left, int depth);
    void gather(const Wavefront& front, int depth);
    void give_up(const Wavefront& front, int depth);
    void end_rays(const GenerationPart& part, int depth);

    /// `enough`: the stop flag of the job. `stop`: that of the user, may be null.
    void limit(std::size_t most_rays, StopFlag& enough, const StopFlag* stop) {
        most_ = most_rays;
        enough_ = &enough;
        stop_ = stop;
    }

    /// Moves the rays of the last call of `trace` out.
    [[nodiscard]] std::vector<RayNode> take();

  private:
    /// The rays of the current generation, and the surfaces of pending ones.
    struct Level {
        std::vector<RayNode> rays;
        std::size_t base = 0;  ///< first ray of the current part
        std::vector<SurfaceNode> met;
    };
    /// A light of the surface being shaded.
    struct SeenLight {
        std::size_t number;
        LightSample light;
        double cosine;
    };

    Level& level(int depth);
    void count_rays(std::size_t more);
    [[nodiscard]] LightTerm term_of(const SeenLight& seen, const ShadingPoint& point,
                                    const Path& path);
    void list_crossings(LightTerm& term) const;
    void set_ambient(const ShadingPoint& point, SurfaceNode& node);
    void set_reasons(const ShadingPoint& point, const Path& path, int depth, const MetSurface& met,
                     SurfaceNode& node) const;

    const Scene& scene_;
    const ShadingConventions& conventions_;
    RayCounters counters_;  ///< of the repeated shadow rays; unused
    ShadowBatch shadows_;
    std::vector<Rgb> ambient_;
    ShadingPoint bare_;  ///< a point with a single term
    std::vector<SeenLight> seen_;
    std::vector<Level> levels_;
    std::size_t count_ = 0, most_ = static_cast<std::size_t>(-1);
    StopFlag* enough_ = nullptr;
    const StopFlag* stop_ = nullptr;
};

}  // namespace alhazen
