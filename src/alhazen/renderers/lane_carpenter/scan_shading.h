#pragma once
/// Shades the samples of a scan line, as `ray_casting` does.
///
/// Conventions: materials, lights and layers are those of the ray tracing renderers; no ray is
/// traced. Threads: one object for each thread.

#include <vector>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/renderers/core/aov_geometry.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/lane_carpenter/patch_block.h"
#include "alhazen/renderers/lane_carpenter/scan_lines.h"

namespace alhazen {

class ScanShading {
  public:
    /// All arguments must outlive the object.
    ScanShading(const RenderJob& job, const ScanScene& scene, const ScreenView& view,
                const SampleGrid& grid, double flatness);

    /// Sets the pixels of scan line `number` of the crop. Returns the number of samples that were
    /// not finite.
    std::uint64_t shade(const ScanRow& row, int number, Film& film);

  private:
    /// The fast case: one sample per pixel, no veils, no layers.
    std::uint64_t shade_plain(const ScanRow& row, int number, Film& film);
    /// Shades a run of consecutive samples that all show something.
    void shade_run(std::span<const ScanSample> seen, const Vec3* columns, const Vec3& of_row,
                   Rgb* pixels);
    /// Shades samples of one patch.
    void shade_patch(std::span<const ScanSample> seen, std::span<const Ray> rays, Rgb* pixels);
    [[nodiscard]] bool is_of_patch(const ScanSample& seen) const;
    /// True if trimming loops remove `point_`.
    [[nodiscard]] bool is_trimmed_away(const ScanSample& seen) const;
    /// The radiance of `point_` in front of the background.
    [[nodiscard]] Rgb color_of_point() const;
    /// Sets `point_`.
    void set_point(const ScanSample& seen, const Ray& ray);
    /// Completes `point_`, whose surface is set, at distance `t_`.
    void complete_point(std::uint32_t source_index, const Ray& ray);
    void set_facet(const ScanFacet& facet, const Ray& ray);
    void set_shape(const ScanSource& source, std::uint32_t part, double t, const Ray& ray);
    [[nodiscard]] double distance(double nearness, const Ray& ray) const;
    /// Radiance of a sample; `veils`: the transparent surfaces in front of it.
    [[nodiscard]] Rgb radiance(std::span<const ScanVeil> veils, const ScanSample& seen,
                               const Ray& ray, PixelGeometry* geometry, bool first);

    const RenderJob& job_;
    const ScanScene& scene_;
    ScreenView view_;
    const SampleGrid& grid_;
    double flatness_;
    EyeRays eye_;
    std::vector<Vec3> columns_;  ///< terms of eye rays
    std::vector<Vec3> sums_;     ///< sums of terms for the rays of a run
    std::vector<Ray> rays_;
    PatchBlock block_;
    std::vector<Rgb> ambient_;
    MaterialCache constant_;
    ShadingPoint point_;
    DepthScale depth_;
    ShapeHits hits_;
    double t_ = 0;  ///< distance of the point
};

}  // namespace alhazen
