#pragma once
/// The effect of a path on polarised light: the product of its Mueller matrices, over the
/// throughput of unpolarised light.
///
/// Source: Wilkie and Weidlich, "Polarised Light in Computer Graphics", SIGGRAPH Asia 2012 courses
/// (Mueller matrices with frames, rotated at each scattering); Collett, "Polarized Light", 1993,
/// chapter 5.
/// Differs: the path goes from the eye to the light, so that matrices are multiplied from the
/// right: the product is the adjoint of that along the light.
/// Conventions: those of shading/optics/polarization.h. The frame at the eye has x to the right of
/// the picture and y up: the angle of polarisation is atan2(U, Q) / 2 from x, counter-clockwise in
/// the picture. Lights emit unpolarised light. Matrix elements are spectra.

#include <array>

#include "alhazen/math/vec.h"
#include "alhazen/shading/bsdf/polarization.h"

namespace alhazen {

struct StokesLight {
    Spectrum i, q, u, v;

    StokesLight& operator+=(const StokesLight& more) {
        i += more.i;
        q += more.q;
        u += more.u;
        v += more.v;
        return *this;
    }
};
[[nodiscard]] inline StokesLight operator*(const StokesLight& s, const Spectrum& light) {
    return {s.i * light, s.q * light, s.u * light, s.v * light};
}
[[nodiscard]] inline StokesLight operator*(double x, const StokesLight& s) {
    return {x * s.i, x * s.q, x * s.u, x * s.v};
}

class PolarizedPath {
  public:
    /// `axis`: x of the frame at the eye, across the ray.
    void begin(const Vec3& axis);

    /// Adds a scattering of light from `direction` to `view`, the previous vertex; both point away
    /// from the surface.
    void scatter(const Vec3& view, const Vec3& direction, const PlaneMueller& matrix);
    /// Adds a scattering that depolarises light.
    void depolarize();

    /// The light at the eye for unpolarised light 1 at the end of the path; i is at least 0.
    [[nodiscard]] StokesLight arrived() const;
    /// As above, with one more scattering.
    [[nodiscard]] StokesLight arrived(const Vec3& view, const Vec3& direction,
                                      const PlaneMueller& matrix) const;

  private:
    /// cos and sin of twice the angle from the frame `x` to that of the path, around `view`.
    [[nodiscard]] Vec2 twice_to_axis(const Vec3& x, const Vec3& view) const;

    Vec3 axis_;
    std::array<std::array<Spectrum, 4>, 4> product_{};  ///< [row][column]
};

/// x of the frame at the eye for a ray along `direction` of a camera with this `up`: to the right
/// of a picture that is not mirrored.
[[nodiscard]] Vec3 picture_axis(const Vec3& direction, const Vec3& up);

}  // namespace alhazen
