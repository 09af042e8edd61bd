#pragma once
/// The surface of a patch at given parameters, for shading.
///
/// Conventions: those of Surface. The point is where the eye ray meets the tangent plane at the
/// given parameters, which are corrected accordingly: a step of Newton's method, and a second one
/// if the first is longer than a quarter of the bound of the error.
/// Complexity: linear in the control points.

#include <vector>

#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/lane_carpenter/patch_block.h"
#include "alhazen/renderers/lane_carpenter/scan_scene.h"

namespace alhazen {

/// `error`: bound of the distance of the point from the patch. Sets the geometry of `surface` and
/// its texture coordinates.
void set_patch_surface(const ScanScene& scene, const ScanPiece& piece, Vec2 parameters,
                       const Ray& ray, double error, Surface& surface);
/// The same from a lane of a block after find_patch_points. Texture coordinates only if `with_uv`.
void set_patch_surface(const ScanScene& scene, const ScanPiece& piece, const PatchBlock& block,
                       std::size_t lane, bool with_uv, Surface& surface);

}  // namespace alhazen
