#pragma once
/// How much of the light Phong's and Blinn's highlights and sheen give back before what is missing
/// is made up for. Tables as ggx_albedo.h.

namespace alhazen {

/// The exponent of a highlight as a roughness, 0..1: sqrt(2 / (n + 2)).
[[nodiscard]] double alpha_of_exponent(double exponent);

[[nodiscard]] double phong_albedo(double mu, double alpha);
[[nodiscard]] double mean_phong_albedo(double alpha);
[[nodiscard]] double blinn_albedo(double mu, double alpha);
[[nodiscard]] double mean_blinn_albedo(double alpha);
/// `roughness` of the sheen, 0..1.
[[nodiscard]] double sheen_albedo(double mu, double roughness);

// The lobes, of which these are the integrals: without cosine, colour 1.

/// `between`: cosine of the mirrored view and the light.
[[nodiscard]] double phong_lobe(double mu_view, double mu_light, double between, double exponent);
/// `half`: cosine of the half vector to the normal, `view_half` to the view.
[[nodiscard]] double blinn_lobe(double mu_view, double mu_light, double half, double view_half,
                                double exponent);
[[nodiscard]] double sheen_lobe(double mu_view, double mu_light, double half, double roughness);

}  // namespace alhazen
