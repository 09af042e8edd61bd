#pragma once
/// Perturbation of normals by a picture, and the tangent frame of its directions.
///
/// Source: Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978; Cohen, Olano and Manocha,
/// "Appearance-Preserving Simplification", SIGGRAPH 1998 (maps in tangent space); Khronos,
/// "glTF 2.0 Specification", 2021, sections 3.7.2.1 and 3.9.3.

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"
#include "alhazen/shading/textures/texture.h"

namespace alhazen {

/// Unit directions along +u and +v of the map. Zero: no frame; normals are not perturbed.
struct TangentFrame {
    Vec3 tangent, bitangent;
};

/// The orthonormal frame of a surface with unit normal `n` and derivatives `dpdu`, `dpdv` of the
/// point by the map's coordinates; left-handed for mirrored coordinates.
[[nodiscard]] TangentFrame frame_from_derivatives(const Vec3& n, const Vec3& dpdu,
                                                  const Vec3& dpdv);
/// The frame from interpolated tangent vectors of a mesh: perpendicular to `n`, unit, with the same
/// handedness.
[[nodiscard]] TangentFrame frame_from_tangents(const Vec3& n, const Vec3& tangent,
                                               const Vec3& bitangent);

/// Converts derivatives by (u, v) to derivatives by the transformed coordinates (u', v'); zero if
/// the transform has no inverse.
void apply_uv_transform(const UvTransform& transform, Vec3& dpdu, Vec3& dpdv);

/// The direction of a texel of a normal map; `n` if it is invalid.
[[nodiscard]] Vec3 bent_normal(const Rgb& texel, double scale, const Vec3& n,
                               const TangentFrame& frame);

}  // namespace alhazen
