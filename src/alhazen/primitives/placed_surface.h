#pragma once
/// The surface of a placed shape or mesh outside any aggregate, for renderers without ray tracing.
///
/// Conventions: those of Surface, with the same bits; `ray` is in world space. A null `placement`
/// is the identity. Part and instance, and the material of a shape, are left to the caller.

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/surface.h"

namespace alhazen {

/// The hit of a flat face of `shape`, found without Shape::intersect, with the parameters that its
/// surface needs.
[[nodiscard]] Hit hit_of_face(const AnyShape& shape, const Placement* placement, const Ray& ray,
                              double t, std::uint32_t face);
void set_shape_surface(const AnyShape& shape, const Placement* placement, const Ray& ray,
                       const Hit& hit, bool with_uv, Surface& surface);
/// The surface of a triangle of a mesh, with its materials.
void set_mesh_surface(const PlacedMesh& mesh, std::uint32_t triangle, const Placement* placement,
                      const Hit& hit, Surface& surface);

}  // namespace alhazen
