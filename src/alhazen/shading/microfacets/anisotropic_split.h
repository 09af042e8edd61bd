#pragma once
/// Single-scattering albedo of rough reflecting surfaces with unequal alphas, in two parts for
/// Schlick's Fresnel term.
///
/// Source: Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course (the two parts).
/// Differs: by both angles of the view and both alphas. The table of the part of f90 has even
/// steps of the square roots of the view's length across the grooves and of its cosine there, and
/// of the fourth roots of the alphas. Nine of ten random views and alphas have errors below 2e-4,
/// one of a hundred above 2e-3; for cosines below 0.01 and alphas below 0.01 the largest found is
/// 3.5e-2.
/// Conventions: as anisotropic_albedo.h.
/// Complexity and threads: the first call takes about half a second; any thread may make it.

#include "alhazen/math/vec.h"
#include "alhazen/shading/microfacets/ggx.h"
#include "alhazen/shading/microfacets/ggx_albedo.h"

namespace alhazen {

[[nodiscard]] SplitAlbedo anisotropic_split_albedo(const Vec3& view, const Ggx& ggx);
/// Cosine-weighted mean over the hemisphere.
[[nodiscard]] SplitAlbedo mean_anisotropic_split_albedo(const Ggx& ggx);

/// The same integrals by quadrature, without a table.
[[nodiscard]] SplitAlbedo integrate_anisotropic_split_albedo(const Vec3& view, const Ggx& ggx);

}  // namespace alhazen
