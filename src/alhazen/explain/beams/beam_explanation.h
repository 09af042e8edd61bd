#pragma once
/// The pieces of `beam_tracing` around a pixel, and the chain of beams to each piece.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984, section 5 (the
/// tree of beams, shaded like a tree of rays).
/// Differs: recorded from the tree of the renderer, over the whole picture for scenes of few
/// polygons, otherwise over the pixels around.
/// Conventions: outlines are in pixels of the picture, x right and y down, one loop each; holes run
/// in the opposite direction. The colours of the pieces that contain the sample point of the pixel
/// add up to the pixel of the picture.

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

using PixelOutline = std::vector<std::vector<Vec2>>;

/// The part of a piece that a light reaches.
struct BeamLitPart {
    std::uint32_t light = 0;
    PixelOutline outline;
    std::vector<std::string> through;  ///< names of transparent objects on the way to the light
    bool holds_sample = false;
    Rgb color;  ///< contribution to the sample point
};

struct BeamPart {
    std::uint32_t id = 0;    ///< number in the tree
    std::uint32_t from = 0;  ///< id of the piece that its beam left; its own id for eye beams
    RayKind kind = RayKind::Eye;
    int depth = 0;
    bool background = false;  ///< the beam meets no surface there
    std::string object;
    PixelOutline outline;
    double share = 0;  ///< fraction of the pixel that it covers
    bool holds_sample = false;
    Rgb own;  ///< contribution of emission and ambient light to the sample point
    std::vector<BeamLitPart> lit;
};

struct BeamExplanation {
    std::string unavailable;  ///< reason if there are no pieces; else empty
    Vec2 from, to;            ///< rectangle of the picture that the tree was made for, in pixels
    std::vector<BeamPart> parts;  ///< in the order of the tree
    std::size_t left_out = 0;     ///< parts beyond the first 600
    std::size_t polygons = 0, beams = 0;
    Rgb color;  ///< at the sample point
};

/// The pieces around a pixel. The job must have its description; it takes one sample per pixel.
[[nodiscard]] BeamExplanation explain_beams(const RenderJob& job, int x, int y, int width,
                                            int height);

}  // namespace alhazen
