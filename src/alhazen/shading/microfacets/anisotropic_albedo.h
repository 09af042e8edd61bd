#pragma once
/// Single-scattering albedo of rough reflecting surfaces with unequal alphas, with a Fresnel term
/// of 1. The deficit to 1 is multiple scattering.
///
/// Source: Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT
/// 3(2), 2014 (the stretched space, in which the surface is a hemisphere); Kulla and Conty,
/// "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017 course (the deficit from a
/// table); Trefethen, "Approximation Theory and Approximation Practice", SIAM 2013, chapters 2 and
/// 3 (interpolation at Chebyshev's points).
/// Differs: the albedo is a smooth function of the stretched view and of both alphas down to 0,
/// unlike that of the view itself; a product of polynomials of degrees 12, 6, 6 and 6 has errors
/// below 5e-4 for views with a cosine of 0.01 and more
/// (tests/unit/shading/bsdf/anisotropic_albedo_test.cpp).
/// Conventions: the view is a unit vector with z > 0, in the frame of Ggx; alphas are clamped to
/// kSmoothAlpha..1.
/// Complexity and threads: the first call takes some hundredths of a second; any thread may make
/// it. Each thread caches the polynomials of the pairs of alphas that it uses repeatedly.

#include <array>
#include <cstddef>

#include "alhazen/math/vec.h"
#include "alhazen/shading/microfacets/ggx.h"

namespace alhazen {

/// The albedo at one pair of alphas.
class AnisotropicAlbedo {
  public:
    AnisotropicAlbedo() = default;
    explicit AnisotropicAlbedo(const Ggx& ggx);

    [[nodiscard]] double at(const Vec3& view) const;

    /// Number of Chebyshev polynomials by the height and the turn of the stretched view.
    static constexpr std::size_t kHeights = 13, kTurns = 7;

  private:
    Ggx ggx_;
    std::array<double, kTurns * kHeights> losses_{};  ///< coefficients of 1 - albedo
};

/// The bits of AnisotropicAlbedo::at.
[[nodiscard]] double anisotropic_albedo(const Vec3& view, const Ggx& ggx);
/// Cosine-weighted mean over the hemisphere.
[[nodiscard]] double mean_anisotropic_albedo(const Ggx& ggx);

/// The same integral by quadrature, without a table.
[[nodiscard]] double integrate_anisotropic_albedo(const Vec3& view, const Ggx& ggx);

}  // namespace alhazen
