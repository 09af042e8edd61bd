#pragma once
/// Conversion of a tree of beams to a drawing: regions of constant or linear colour, and lines at
/// the borders of planes and objects.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984, section 6 (the
/// tree as polygons, for any resolution).
/// Differs: a region whose shading is not linear within the tolerance is divided. It is tested at
/// the points of a grid, and at those nearest to features of its lights (light_features.h), which
/// the grid may miss. Lines follow from
/// the regions: the border of a plane is that of the union of its pieces, so that cuts of the tree
/// and of shadows do not produce lines.
/// Conventions: those of Drawing. Threads: regions are shaded in parallel; the drawing is
/// independent of their number.
/// for any number of them.

#include <functional>
#include <string>

#include "alhazen/imaging/drawing/drawing.h"
#include "alhazen/renderers/beam_tracing/beam_tree.h"

namespace alhazen {

struct BeamDrawingOptions {
    int width = 0, height = 0;  ///< size of the picture, pixels
    bool shaded = true;         ///< false: all regions are white
    bool lines = false;
    double tolerance = 1.5 / 255;  ///< largest error of encoded colours
    /// Name of a part, for its title.
    std::function<std::string(std::uint32_t part)> name_of;
};

[[nodiscard]] Drawing beam_drawing(const RenderJob& job, const BeamScene& scene,
                                   const BeamTree& tree, const BeamDrawingOptions& options);

}  // namespace alhazen
