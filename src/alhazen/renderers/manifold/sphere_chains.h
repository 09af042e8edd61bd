#pragma once
/// All chains from a point by a sphere to a light, in closed form: seeds that leave no chain out.
///
/// Source: alhazens_problem.h (reflections); docs/design/alhazens_problem.md (two refractions: a
/// chain is known by the distance b of its rays from the centre, which the ball does not change).
/// Differs: for two refractions the angle at the centre, as a function of b, has at most two
/// extremes where the ball is denser than what is around it; its monotonous pieces are searched.
/// Conventions: directions from the point, unit. Nothing else is in the way. Where the centre, the
/// point and the light are in line, rings of chains are left out.

#include "alhazen/base/inline_vector.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/renderers/manifold/chain_solver.h"

namespace alhazen {

using ChainSeeds = InlineVector<Vec3, 8>;

/// Points and ends on the sphere have no chains.
[[nodiscard]] ChainSeeds reflections_by_sphere(const BoundingSphere& sphere, const Vec3& from,
                                               const ChainEnd& end);
/// `index` of the ball over that around it, at least 1; both ends are outside.
[[nodiscard]] ChainSeeds refractions_by_ball(const BoundingSphere& sphere, double index,
                                             const Vec3& from, const ChainEnd& end);

/// By a plane: at most one each.
[[nodiscard]] ChainSeeds reflections_by_plane(const Vec3& point, const Vec3& normal,
                                              const Vec3& from, const ChainEnd& end);
/// `eta`: index on the side of `from` over that of the end.
[[nodiscard]] ChainSeeds refractions_by_plane(const Vec3& point, const Vec3& normal, double eta,
                                              const Vec3& from, const ChainEnd& end);

}  // namespace alhazen
