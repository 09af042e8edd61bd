#pragma once
/// Converts height images (bump maps) to normal maps.
///
/// Source: Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978 (normals from the slopes of
/// heights).
/// Differs: slopes are differences of neighbouring texels, computed once per image instead of once
/// per surface point; heights are relative to the image, not in scene units.
/// Conventions: white at strength 1 lies 1 / kHeightsPerSide of the image side above black; the
/// side is the geometric mean of width and height, and texels are assumed square on the surface.
/// The slopes are therefore independent of the image resolution and of the model size.

#include "alhazen/imaging/codecs/stored_image.h"
#include "alhazen/shading/materials/material.h"

namespace alhazen {

inline constexpr double kHeightsPerSide = 100.0;

/// Interpretation of a height image.
struct HeightMap {
    double strength = 1;  ///< factor of the heights; negative: white is low
    Channel channel = Channel::Mean;
    Wrap wrap = Wrap::Repeat;  ///< neighbours of border texels; Repeat or Clamp
};

/// True if an image holds directions rather than heights: at least three quarters of its texels are
/// saturated, have blue as the largest channel, and are of unit length (within 0.2) as (2 r - 1, 2
/// g - 1, 2 b - 1).
[[nodiscard]] bool looks_like_normal_map(const StoredImage& picture);

/// The normals of a height image in the encoding of NormalMap: three channels of 8-bit codes.
/// Nonfinite heights count as 0.
[[nodiscard]] StoredImage normals_from_heights(const StoredImage& heights, const HeightMap& map);

}  // namespace alhazen
