#pragma once
/// Shades the samples of a scan line, with the look of `ray_casting`.
///
/// Conventions: materials, lights and layers are those of the ray renderers; no ray is traced. One
/// object for each thread.

#include <vector>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/renderers/core/aov_geometry.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/lane_carpenter/scan_lines.h"

namespace alhazen {

class ScanShading {
  public:
    /// All must outlive the object.
    ScanShading(const RenderJob& job, const ScanScene& scene, const ScreenView& view,
                const SampleGrid& grid, double flatness);

    /// Sets the pixels of scan line `row` of the crop. Returns the number of samples that were not
    /// finite.
    std::uint64_t shade(const ScanRow& row, int number, Film& film);

  private:
    /// One sample a pixel, none before another, no layers.
    std::uint64_t shade_plain(const ScanRow& row, int number, Film& film);
    /// Sets `point_`; false where nothing is there.
    void set_point(const ScanSample& seen, const Ray& ray);
    void set_facet(const ScanFacet& facet, const Ray& ray);
    void set_shape(const ScanSource& source, std::uint32_t part, double t, const Ray& ray);
    [[nodiscard]] double distance(double nearness, const Ray& ray) const;
    /// Radiance of a sample; `veils`: those before it.
    [[nodiscard]] Rgb radiance(std::span<const ScanVeil> veils, const ScanSample& seen,
                               const Ray& ray, PixelGeometry* geometry, bool first);

    const RenderJob& job_;
    const ScanScene& scene_;
    ScreenView view_;
    const SampleGrid& grid_;
    double flatness_;
    EyeRays eye_;
    std::vector<Vec3> columns_;  ///< terms of eye rays
    std::vector<Rgb> ambient_;
    MaterialCache constant_;
    ShadingPoint point_;
    DepthScale depth_;
    ShapeHits hits_;
    double t_ = 0;  ///< of the point
};

}  // namespace alhazen
