#pragma once
/// `eye_ray` for many rays of one camera: what depends on x and on y alone is found apart, for
/// whole columns and rows of a picture.
///
/// Source: none. Differs: nothing. Conventions: those of the cameras; the bits are those of
/// `eye_ray`.

#include <span>

#include "alhazen/cameras/camera.h"

namespace alhazen {

class EyeRays {
  public:
    explicit EyeRays(const Camera& camera)
        : from_eye_(std::holds_alternative<PerspectiveCamera>(camera)) {
        if (const auto* p = std::get_if<PerspectiveCamera>(&camera)) {
            set(p->eye, p->look, p->right, p->up);
        } else {
            const auto& o = std::get<OrthographicCamera>(camera);
            set(normalize(o.direction), o.origin, o.right, o.up);
        }
    }

    /// What the rays of one x share.
    [[nodiscard]] Vec3 column(double x) const { return middle_ + (x - 0.5) * right_; }
    /// What the rays of one y share.
    [[nodiscard]] Vec3 row(double y) const { return (y - 0.5) * up_; }
    /// `sum`: of a column and a row, in this order.
    [[nodiscard]] Ray ray(const Vec3& sum) const {
        return from_eye_ ? Ray{fixed_, normalize(sum)} : Ray{sum, fixed_};
    }
    /// As many rays as sums.
    void rays(std::span<const Vec3> sums, Ray* out) const;

  private:
    void set(const Vec3& fixed, const Vec3& middle, const Vec3& right, const Vec3& up) {
        fixed_ = fixed;
        middle_ = middle;
        right_ = right;
        up_ = up;
    }

    bool from_eye_;
    Vec3 fixed_;  ///< the eye, or the direction of all rays
    Vec3 middle_, right_, up_;
};

}  // namespace alhazen
