#pragma once
/// Normals bent by a picture, and the frame in the surface that its directions refer to.
///
/// Source: Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978; Cohen, Olano and Manocha,
/// "Appearance-Preserving Simplification", SIGGRAPH 1998 (maps in tangent space); Khronos,
/// "glTF 2.0 Specification", 2021, sections 3.7.2.1 and 3.9.3.

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"
#include "alhazen/shading/textures/texture.h"

namespace alhazen {

/// Directions along +u and +v of the map. Zero: there is no frame, normals are not bent.
struct TangentFrame {
    Vec3 tangent, bitangent;
};

/// The frame of a surface with unit normal `n` whose point changes by `dpdu`, `dpdv` with the
/// coordinates of the map, made orthonormal; mirrored coordinates give a left-handed one.
[[nodiscard]] TangentFrame frame_from_derivatives(const Vec3& n, const Vec3& dpdu,
                                                  const Vec3& dpdv);
/// From interpolated tangent vectors of a mesh: perpendicular to `n`, unit, the handedness kept.
[[nodiscard]] TangentFrame frame_from_tangents(const Vec3& n, const Vec3& tangent,
                                               const Vec3& bitangent);

/// Derivatives by transformed coordinates (u', v') from those by (u, v); zero when the transform
/// has no inverse.
void apply_uv_transform(const UvTransform& transform, Vec3& dpdu, Vec3& dpdv);

/// The direction that a texel of a normal map stands for; `n` when it stands for none.
[[nodiscard]] Vec3 bent_normal(const Rgb& texel, double scale, const Vec3& n,
                               const TangentFrame& frame);

}  // namespace alhazen
