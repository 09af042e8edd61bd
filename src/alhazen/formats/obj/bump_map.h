#pragma once
/// Pictures of heights (bump maps) as normal maps.
///
/// Source: Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978 (normals from the slopes of
/// heights). Differs: slopes are those between neighbouring texels, taken once for the picture, not
/// per point of the surface; heights are relative to the picture, not in scene units.
/// Conventions: white at strength 1 lies 1 / kHeightsPerSide of the picture's side above black; the
/// side is the geometric mean of width and height, and texels are taken as square on the surface.
/// So the slopes depend neither on the resolution of the picture nor on the size of the model.

#include "alhazen/imaging/codecs/stored_image.h"
#include "alhazen/shading/materials/material.h"

namespace alhazen {

inline constexpr double kHeightsPerSide = 100.0;

/// How a picture of heights is to be read.
struct HeightMap {
    double strength = 1;  ///< times the heights; negative: white is deep
    Channel channel = Channel::Mean;
    Wrap wrap = Wrap::Repeat;  ///< which neighbours texels at the rim have; Repeat or Clamp
};

/// Whether a picture is one of directions rather than of heights: at least three quarters of its
/// texels are saturated, bluest in blue, and of unit length (within 0.2) as (2 r - 1, 2 g - 1,
/// 2 b - 1).
[[nodiscard]] bool looks_like_normal_map(const StoredImage& picture);

/// The normals of a picture of heights, stored as NormalMap has them, in three channels of 8-bit
/// codes. Heights that are not finite count as 0.
[[nodiscard]] StoredImage normals_from_heights(const StoredImage& heights, const HeightMap& map);

}  // namespace alhazen
