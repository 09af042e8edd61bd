#pragma once
/// A layer that reflects part of the light and transmits the rest to the lobes below: clear coat,
/// sheen, the face of a sheet. The layer's own reflection is a lobe; a Cover is the attenuation of
/// the lobes below.
///
/// Source: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", Imageworks 2017, section
/// 4 (albedo scaling).

namespace alhazen {

class Cover {
  public:
    Cover() = default;
    /// A face of roughness alpha with reflectance f0 + (f90 - f0) (1 - cosine)^5; of coloured
    /// reflectances pass the largest channel. `share`: fraction of the surface that it covers.
    [[nodiscard]] static Cover face(double alpha, double f0, double f90, double share = 1);
    /// Fibres; `color` is the largest channel of their colour.
    [[nodiscard]] static Cover sheen(double roughness, double color);

    /// Share of light transmitted at this cosine to the normal, 0..1.
    [[nodiscard]] double transmittance(double cosine) const;
    /// Cosine-weighted mean of the transmittance over the hemisphere; faces only.
    [[nodiscard]] double mean_transmittance() const;
    [[nodiscard]] double share() const { return share_; }

  private:
    bool sheen_ = false;
    double share_ = 0, roughness_ = 0;  ///< roughness: alpha of a face; below kSmoothAlpha: smooth
    double f0_ = 0, f90_ = 1;           ///< reflectances of a face
    double several_ = 0;                ///< reflected share of light that meets several facets
};

}  // namespace alhazen
