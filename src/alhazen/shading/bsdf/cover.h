#pragma once
/// A layer that reflects a part of the light and leaves the rest to what lies below: a clear coat,
/// sheen, the face of a sheet. Its own reflection is a lobe; this is what it takes from others.
///
/// Source: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", Imageworks 2017, section
/// 4 (albedo scaling).

namespace alhazen {

class Cover {
  public:
    Cover() = default;
    /// A face of this roughness alpha that reflects f0 + (f90 - f0) (1 - cosine)^5: of colours the
    /// largest channels. `share`: how much of the surface it covers.
    [[nodiscard]] static Cover face(double alpha, double f0, double f90, double share = 1);
    /// Fibres; `color`: their largest channel.
    [[nodiscard]] static Cover sheen(double roughness, double color);

    /// What it leaves of light at this cosine to the normal, 0..1.
    [[nodiscard]] double transmittance(double cosine) const;
    /// The mean over the hemisphere, weighted by the cosine; of a face.
    [[nodiscard]] double mean_transmittance() const;
    [[nodiscard]] double share() const { return share_; }

  private:
    bool sheen_ = false;
    double share_ = 0, roughness_ = 0;  ///< roughness: alpha of a face; below kSmoothAlpha: smooth
    double f0_ = 0, f90_ = 1;           ///< of a face
    double several_ = 0;                ///< reflected share of light that meets several facets
};

}  // namespace alhazen
