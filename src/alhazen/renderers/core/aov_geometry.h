#pragma once
/// The geometry of a pixel for its AOVs, gathered from the surfaces that its samples see.
///
/// Conventions: those of aov.h.

#include <algorithm>

#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/local_shading.h"

namespace alhazen {

/// Depth of points: the distance from the eye along the normal of the image plane; for a wide
/// camera the distance from the eye.
class DepthScale {
  public:
    explicit DepthScale(const Camera& camera) {
        const PicturePlane plane = picture_plane(camera);
        eye_ = plane.eye;
        axis_ = normalize(cross(plane.up, plane.right));
        if (dot(axis_, plane.forward) < 0.0) axis_ = -axis_;
        wide_ = std::holds_alternative<WideCamera>(camera);
    }
    [[nodiscard]] double depth(const Vec3& point) const {
        return wide_ ? length(point - eye_) : dot(point - eye_, axis_);
    }

  private:
    Vec3 eye_, axis_;
    bool wide_ = false;
};

/// Sums over the samples of a pixel.
struct PixelGeometry {
    int samples = 0, hits = 0;
    double depth = 0, error = 0;
    Vec3 normal, geometric, position;
    Vec2 uv;
    Rgb albedo;
    std::uint32_t object = 0, material = 0, instance = 0;

    void add_ids(const Surface& surface) {
        object = surface.part + 1;
        instance = surface.instance + 1;
        std::size_t heaviest = 0;
        for (std::size_t i = 1; i < static_cast<std::size_t>(surface.material_count); ++i) {
            if (surface.weights[i] > surface.weights[heaviest]) heaviest = i;
        }
        material = static_cast<std::uint32_t>(surface.materials[heaviest]) + 1;
    }

    void add(const ShadingPoint& point, const DepthScale& scale) {
        const Surface& surface = point.surface;
        depth += scale.depth(surface.point);
        normal += point.normal;
        geometric += point.geometric;
        position += surface.point;
        uv = {uv.x + surface.uv.x, uv.y + surface.uv.y};
        albedo += point.material->albedo;
        error = std::max(error, length(surface.error));
        ++hits;
    }
};

/// Sets the geometry of pixel (i, j).
void write_geometry(AovFilm& film, int i, int j, const PixelGeometry& g);

}  // namespace alhazen
