#pragma once
/// A layer that reflects part of the light and transmits the rest to the lobes below: clear coat,
/// sheen, the face of a sheet. The layer's own reflection is a lobe; a Cover is the attenuation of
/// the lobes below.
///
/// Source: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", Imageworks 2017, section
/// 4 (albedo scaling).

#include <algorithm>

#include "alhazen/math/vec.h"
#include "alhazen/shading/microfacets/ggx.h"
#include "alhazen/shading/microfacets/ggx_albedo.h"

namespace alhazen {

class Cover {
  public:
    Cover() = default;
    /// A face of roughness alpha with reflectance f0 + (f90 - f0) (1 - cosine)^5; of coloured
    /// reflectances pass the largest channel. `share`: fraction of the surface that it covers.
    [[nodiscard]] static Cover face(double alpha, double f0, double f90, double share = 1);
    /// The same with grooves. `axis`: unit tangent along which the roughness is ggx.x.
    [[nodiscard]] static Cover face(const Ggx& ggx, const Vec2& axis, double f0, double f90,
                                    double share = 1);
    /// Fibres; `color` is the largest channel of their colour.
    [[nodiscard]] static Cover sheen(double roughness, double color);

    /// Share of light transmitted from this unit direction, on either side: 0..1.
    [[nodiscard]] double transmittance(const Vec3& direction) const;
    /// Cosine-weighted mean of the transmittance over the hemisphere; faces only.
    [[nodiscard]] double mean_transmittance() const;
    [[nodiscard]] double share() const { return share_; }

  private:
    [[nodiscard]] bool is_rough() const { return std::max(ggx_.x, ggx_.y) >= kSmoothAlpha; }
    [[nodiscard]] bool is_anisotropic() const { return ggx_.x != ggx_.y; }
    /// Single-scattering albedo of a rough face.
    [[nodiscard]] SplitAlbedo single(const Vec3& direction) const;
    /// Of the face, given its single-scattering albedo.
    [[nodiscard]] double reflectance(const SplitAlbedo& one) const;

    bool sheen_ = false;
    double share_ = 0;
    Ggx ggx_{0, 0};  ///< of a face; of sheen both are the roughness
    Vec2 axis_{1, 0};
    double f0_ = 0, f90_ = 1;  ///< reflectances of a face
    double several_ = 0;       ///< reflected share of light that meets several facets
};

}  // namespace alhazen
