#pragma once
/// The screen space of a camera in homogeneous coordinates, and the fixed-point grid of edges.
///
/// Source: Blinn and Newell, "Clipping Using Homogeneous Coordinates", SIGGRAPH 1978.
/// Conventions: a point has x / w and y / w in pixels of the frame, y downward, and the nearness z
/// / w: affine in x and y along a plane, larger is nearer to the eye. It is 1 / depth for a
/// perspective camera, minus the depth for a parallel one; depth is measured along the camera's
/// view direction, whose length is 1. Points in front of the eye have w > 0. Homogeneous points of
/// a scene are (w P, w) with w > 0, or directions (P, 0): points at infinity.

#include <cstdint>

#include "alhazen/cameras/camera.h"
#include "alhazen/math/affine.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

/// A point on the grid of fixed-point numbers.
struct FixedPoint {
    std::int32_t x = 0, y = 0;
    friend bool operator==(const FixedPoint&, const FixedPoint&) = default;
};

/// A projected point: pixels, and the nearness.
struct ScreenPoint {
    double x = 0, y = 0, nearness = 0;
};

/// Nearness along a plane: x * gx + y * gy + at_origin, pixels.
struct NearnessPlane {
    double gx = 0, gy = 0, at_origin = 0;
    bool seen = false;  ///< false: the plane degenerates to a line in the picture
};

class ScreenView {
  public:
    /// `farthest`: largest distance of the scene's points from the eye; determines the near plane.
    ScreenView(const Camera& camera, int frame_width, int frame_height, double farthest);

    [[nodiscard]] HomogeneousPoint on_screen(const HomogeneousPoint& world) const {
        const Vec3 p{world.x - world.w * eye_.x, world.y - world.w * eye_.y,
                     world.z - world.w * eye_.z};
        const double a = dot(to_right_, p), b = dot(to_up_, p), c = dot(to_look_, p);
        const double w = parallel_ ? world.w : c;
        return {(a + 0.5 * w) * width_, (0.5 * w - b) * height_, parallel_ ? -c : world.w, w};
    }
    /// True if a point is in front of the eye by at least the least depth.
    [[nodiscard]] bool in_front(const HomogeneousPoint& p) const {
        return parallel_ ? p.w > 0.0 : p.w >= least_depth_ * p.z && p.w > 0.0;
    }
    /// Signed: positive in front of the near plane.
    [[nodiscard]] double before_eye(const HomogeneousPoint& p) const {
        return parallel_ ? -p.z : p.w - least_depth_ * p.z;
    }
    [[nodiscard]] NearnessPlane nearness_of(const Vec3& point, const Vec3& normal) const;

    [[nodiscard]] bool parallel() const { return parallel_; }
    /// The camera's view direction; of length 1 for a parallel camera.
    [[nodiscard]] const Vec3& look() const { return look_; }
    /// Change of depth along a vector.
    [[nodiscard]] double depth_of(const Vec3& v) const { return dot(to_look_, v); }
    /// Largest nearness in front of the eye.
    [[nodiscard]] double most_nearness() const;
    /// Pixels per unit of nearness, where the nearness is `at`.
    [[nodiscard]] double pixels_of_nearness(double at) const {
        return parallel_ ? depth_pixels_ : depth_pixels_ / at;
    }
    /// Size of a pixel in the scene at a nearness.
    [[nodiscard]] double pixel_size(double nearness) const {
        return parallel_ ? pixel_ : pixel_ / nearness;
    }

    /// Largest coordinate of edges on the grid, and, as `reach`, of pixels.
    static constexpr std::int32_t kMostGrid = 1 << 30;
    [[nodiscard]] double reach() const { return reach_; }
    [[nodiscard]] double grid_per_pixel() const { return grid_; }
    [[nodiscard]] std::int32_t to_grid(double pixels) const {
        const double place = std::floor(pixels * grid_ + 0.5);
        constexpr double kMost = kMostGrid;
        return static_cast<std::int32_t>(place > kMost ? kMost : place < -kMost ? -kMost : place);
    }

  private:
    bool parallel_ = false;
    Vec3 eye_, to_right_, to_up_, to_look_;  ///< rows of the inverse of the camera's frame
    Vec3 right_, up_, look_;
    double width_, height_;
    double least_depth_ = 0;
    double depth_pixels_ = 1, pixel_ = 1;
    double reach_ = 0, grid_ = 1;
};

}  // namespace alhazen
