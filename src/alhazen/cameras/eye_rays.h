#pragma once
/// Eye rays of one camera in large numbers: the terms of x and of y are computed once for whole
/// columns and rows of an image.
///
/// Conventions: those of camera.h; the rays have the bits of `eye_ray`.

#include <optional>
#include <span>

#include "alhazen/base/overloaded.h"
#include "alhazen/cameras/camera.h"
#include "alhazen/cameras/wide_view.h"

namespace alhazen {

class EyeRays {
  public:
    explicit EyeRays(const Camera& camera) {
        std::visit(Overloaded{[this](const PerspectiveCamera& c) {
                                  from_eye_ = true;
                                  set(c.eye, c.look, c.right, c.up);
                              },
                              [this](const OrthographicCamera& c) {
                                  from_eye_ = false;
                                  set(normalize(c.direction), c.origin, c.right, c.up);
                              },
                              [this](const WideCamera& c) {
                                  from_eye_ = false;
                                  wide_.emplace(c);
                                  // The sums of columns and rows are film coordinates.
                                  set(c.eye, {0.5, 0.5, 0}, {1, 0, 0}, {0, 1, 0});
                              }},
                   camera);
    }

    /// The term of film coordinate x.
    [[nodiscard]] Vec3 column(double x) const { return middle_ + (x - 0.5) * right_; }
    /// The term of film coordinate y.
    [[nodiscard]] Vec3 row(double y) const { return (y - 0.5) * up_; }
    /// The ray for `sum`, a column plus a row, in this order.
    [[nodiscard]] Ray ray(const Vec3& sum) const {
        if (from_eye_) return {fixed_, normalize(sum)};
        return wide_ ? Ray{fixed_, wide_->direction(sum.x, sum.y)} : Ray{sum, fixed_};
    }
    /// Writes one ray for each sum.
    void rays(std::span<const Vec3> sums, Ray* out) const;

  private:
    void set(const Vec3& fixed, const Vec3& middle, const Vec3& right, const Vec3& up) {
        fixed_ = fixed;
        middle_ = middle;
        right_ = right;
        up_ = up;
    }

    bool from_eye_ = true;  ///< true: rays run from the eye; false: parallel, or those of `wide_`
    Vec3 fixed_;            ///< the eye, or the direction of all rays
    Vec3 middle_, right_, up_;
    std::optional<WideView> wide_;
};

/// Rays through points of a camera's lens.
///
/// Source: Cook, Porter and Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984, section 4.4.
/// Conventions: all rays of one point of the film meet in the plane of focus, which is parallel to
/// the picture.
class LensRays {
  public:
    explicit LensRays(const Camera& camera);

    /// False for a pinhole, whose rays `through` leaves unchanged.
    [[nodiscard]] bool open() const { return lens_.radius > 0.0; }
    /// The unit ray through the point of the lens that `u` in the unit square selects, for the ray
    /// through the centre of the lens.
    [[nodiscard]] Ray through(const Ray& ray, const Vec2& u) const;

  private:
    Lens lens_;
    Vec3 normal_, across_, along_;  ///< unit: the picture's normal, two in its plane
};

}  // namespace alhazen
