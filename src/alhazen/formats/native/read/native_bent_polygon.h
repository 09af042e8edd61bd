#pragma once
/// Polygons of native scenes whose corners are not in a plane.

#include "alhazen/formats/native/read/native_context.h"
#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

/// Replaces a polygon of one loop whose corners are off its plane (`is_flat`) by a mesh of its
/// triangles, with the polygon's texture coordinates; a polygon of several loops, or of one that
/// crosses itself, stays as it is. Warns in both cases.
void replace_bent_polygon(NativeContext& context, Part& part);

/// Replaces the polygon of a light whose corners are off its plane by its triangles; one that
/// crosses itself, by the polygon in its mean plane. Warns in both cases.
void replace_bent_polygon(NativeContext& context, const FileLocation& where, LightExtent& extent);

}  // namespace alhazen
