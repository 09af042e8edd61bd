#pragma once
/// Single-scattering albedo of rough reflecting surfaces. The deficit to 1 is multiple scattering.
///
/// Source: Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017
/// course (the deficit from a table); Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013
/// course (the table in two parts for Schlick's formula).
/// Differs: tables are computed by quadrature at the first use; the error of the sum is below 5e-4,
/// of its parts below 2e-3, for alpha >= 0.0025 and mu >= 0.01
/// (tests/unit/shading/bsdf/albedo_tables_test.cpp).
/// Conventions: mu is the cosine of the view, 0..1; alpha the roughness of Ggx, 0..1.
/// Complexity and threads: the first call takes some tenths of a second; any thread may make it.

#include "alhazen/shading/microfacets/albedo_table.h"

namespace alhazen {

/// Albedo with Schlick's Fresnel term: f0 * at_f0 + f90 * at_f90.
struct SplitAlbedo {
    double at_f0 = 1, at_f90 = 0;

    [[nodiscard]] double sum() const { return at_f0 + at_f90; }
};

[[nodiscard]] SplitAlbedo ggx_albedo(double mu, double alpha);
/// The albedo with a Fresnel term of 1.
[[nodiscard]] double ggx_albedo_sum(double mu, double alpha);
/// `ggx_albedo_sum` of one alpha.
[[nodiscard]] AlbedoTable::Slice ggx_albedo_sums(double alpha);
/// Cosine-weighted mean over the hemisphere.
[[nodiscard]] SplitAlbedo ggx_mean_albedo(double alpha);

/// The same integral by quadrature, without a table.
[[nodiscard]] SplitAlbedo integrate_ggx_albedo(double mu, double alpha);

}  // namespace alhazen
