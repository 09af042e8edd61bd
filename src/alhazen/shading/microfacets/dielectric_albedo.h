#pragma once
/// Single-scattering albedo of rough boundaries between clear media: reflected and transmitted.
///
/// Source: Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017
/// course (dielectrics, both directions).
/// Differs: computed by quadrature when first used; see albedo_table.h for the axes.
/// Conventions: as ggx_albedo.h; `eta` is the index on the side of the view over that behind,
/// clamped to 1/3..3.
/// Complexity and threads: the first call takes about a second; any thread may make it.

namespace alhazen {

struct DielectricAlbedo {
    double reflected = 0, sum = 1;
};

[[nodiscard]] DielectricAlbedo dielectric_albedo(double mu, double alpha, double eta);
/// Cosine-weighted mean of `sum` over the hemisphere.
[[nodiscard]] double mean_dielectric_albedo(double alpha, double eta);
/// The same integral by quadrature, without a table.
[[nodiscard]] DielectricAlbedo integrate_dielectric_albedo(double mu, double alpha, double eta);

}  // namespace alhazen
