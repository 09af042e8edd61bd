#pragma once
/// All specular chains from a point by a sphere or plane to a light, in closed form.
///
/// Source: alhazens_problem.h (reflections); docs/design/alhazens_problem.md (two refractions: a
/// chain is determined by the distance b of its rays from the centre, which refraction preserves).
/// Differs: for two refractions the angle at the centre, as a function of b, has at most two
/// extrema if the ball is denser than its surroundings; its monotone pieces are searched.
/// Conventions: results are unit directions from the point. Occlusion is ignored. If the centre,
/// the point and the light are collinear, rings of chains are omitted.

#include "alhazen/base/inline_vector.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/renderers/manifold/chain_solver.h"

namespace alhazen {

using ChainSeeds = InlineVector<Vec3, 8>;

/// Empty if the point or the end is on the sphere.
[[nodiscard]] ChainSeeds reflections_by_sphere(const BoundingSphere& sphere, const Vec3& from,
                                               const ChainEnd& end);
/// `index` of the ball over that around it, at least 1; both ends must be outside.
[[nodiscard]] ChainSeeds refractions_by_ball(const BoundingSphere& sphere, double index,
                                             const Vec3& from, const ChainEnd& end);

/// By a plane: at most one chain each.
[[nodiscard]] ChainSeeds reflections_by_plane(const Vec3& point, const Vec3& normal,
                                              const Vec3& from, const ChainEnd& end);
/// `eta`: index on the side of `from` over that on the side of the end.
[[nodiscard]] ChainSeeds refractions_by_plane(const Vec3& point, const Vec3& normal, double eta,
                                              const Vec3& from, const ChainEnd& end);

}  // namespace alhazen
