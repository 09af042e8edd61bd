#pragma once
/// The solids of a cone scene that contain a point.
///
/// Source: Haines, "Point in Polygon Strategies", Graphics Gems IV, 1994 (the odd-even rule, here
/// of a line and a closed mesh; Haines's convention for edges).
/// Conventions: points on a boundary count as inside, those of meshes as either.
/// Complexity: O(log n) for n solids whose boxes do not overlap; in a mesh O(triangles near the
/// line).

#include "alhazen/base/inline_vector.h"
#include "alhazen/renderers/cone_tracing/cone_scene.h"

namespace alhazen {

/// Indices of sources. Of more than eight the smallest boxes, which a view meets first.
using SolidsAround = InlineVector<std::uint32_t, 8>;

[[nodiscard]] SolidsAround solids_around(const ConeScene& scene, const Vec3& point);

}  // namespace alhazen
