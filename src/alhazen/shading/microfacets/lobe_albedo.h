#pragma once
/// Albedo of Phong's and Blinn's highlights and of sheen, without the matt lobe that restores the
/// deficit. Tabulated as in ggx_albedo.h.

namespace alhazen {

/// Roughness, 0..1, equivalent to the exponent of a highlight: sqrt(2 / (n + 2)).
[[nodiscard]] double alpha_of_exponent(double exponent);

[[nodiscard]] double phong_albedo(double mu, double alpha);
[[nodiscard]] double mean_phong_albedo(double alpha);
[[nodiscard]] double blinn_albedo(double mu, double alpha);
[[nodiscard]] double mean_blinn_albedo(double alpha);
/// `roughness` of the sheen, 0..1.
[[nodiscard]] double sheen_albedo(double mu, double roughness);

// Integrands of these albedos: the lobes of colour 1, without the cosine.

/// `between`: cosine between the mirrored view and the light.
[[nodiscard]] double phong_lobe(double mu_view, double mu_light, double between, double exponent);
/// `half`: cosine of the half vector to the normal, `view_half`: of the view to the half vector.
[[nodiscard]] double blinn_lobe(double mu_view, double mu_light, double half, double view_half,
                                double exponent);
/// Its albedo is at most 1, by the table of `sheen_albedo`, which is true down to a cosine of 0.01:
/// below it errs by up to a third.
[[nodiscard]] double sheen_lobe(double mu_view, double mu_light, double half, double roughness);

}  // namespace alhazen
