#pragma once
/// The surface of a placed shape or mesh that no aggregate holds: for renderers that trace no rays.
///
/// Conventions: those of Surface, and its bits; `ray` is in world space. `placement` may be null:
/// none. Part and instance are left to the caller, and the material of a shape.

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/surface.h"

namespace alhazen {

void set_shape_surface(const AnyShape& shape, const Placement* placement, const Ray& ray,
                       const Hit& hit, bool with_uv, Surface& surface);
/// For a triangle of a mesh; sets the materials.
void set_mesh_surface(const PlacedMesh& mesh, std::uint32_t triangle, const Placement* placement,
                      const Hit& hit, Surface& surface);

}  // namespace alhazen
