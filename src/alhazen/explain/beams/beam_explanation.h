#pragma once
/// The pieces of `beam_tracing` around a pixel, and the chain of beams that ends in it.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984, section 5 (the
/// tree of beams, shaded as a tree of rays is).
/// Differs: recorded from the tree of the renderer, over the whole picture where the scene has few
/// polygons, else over the pixels around.
/// Conventions: outlines are in pixels of the picture, x right and y down, a loop each; holes run
/// the other way round. The colours of the pieces that hold the sample point of the pixel add up to
/// that of the picture.

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

using PixelOutline = std::vector<std::vector<Vec2>>;

/// A part of a piece that a light reaches.
struct BeamLitPart {
    std::uint32_t light = 0;
    PixelOutline outline;
    std::vector<std::string> through;  ///< objects that let the light through
    bool holds_sample = false;
    Rgb color;  ///< that it adds to the sample point
};

struct BeamPart {
    std::uint32_t id = 0;    ///< of the tree
    std::uint32_t from = 0;  ///< the piece that its beam left; its own id where the eye sees it
    RayKind kind = RayKind::Eye;
    int depth = 0;
    bool background = false;  ///< nothing is seen there
    std::string object;
    PixelOutline outline;
    double share = 0;  ///< of the pixel that it covers
    bool holds_sample = false;
    Rgb own;  ///< emission and ambient light that it adds to the sample point
    std::vector<BeamLitPart> lit;
};

struct BeamExplanation {
    std::string unavailable;      ///< why there are no pieces
    Vec2 from, to;                ///< the part of the picture that the tree was made for, in pixels
    std::vector<BeamPart> parts;  ///< in the order of the tree
    std::size_t left_out = 0;     ///< parts beyond the first 600
    std::size_t polygons = 0, beams = 0;
    Rgb color;  ///< of the sample point
};

/// The job must have its description; it takes one sample a pixel.
[[nodiscard]] BeamExplanation explain_beams(const RenderJob& job, int x, int y, int width,
                                            int height);

}  // namespace alhazen
