#pragma once
/// The surface at a hit of a triangle of a mesh, in lanes of coordinates.
///
/// Conventions: the bits are those of scalar code on every target (triangle_normal,
/// TriangleMesh::uv_derivatives).

#include <cstddef>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// Sets the surface at a hit whose u, v are the weights of the second and third vertex. Returns the
/// largest distance of a vertex from the point, along any axis.
double set_triangle_surface(const TriangleMesh& mesh, std::size_t triangle, const ShapeHit& hit,
                            ShapeSurface& surface);

}  // namespace alhazen
