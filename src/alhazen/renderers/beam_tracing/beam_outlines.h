#pragma once
/// Lines of a drawing: where planes and objects end in the picture.
///
/// Source: edges follow from the visible regions, as in Weiler and Atherton, "Hidden Surface
/// Removal Using Polygon Area Sorting", SIGGRAPH 1977, section 6 (outlines of polygons that were
/// cut). Conventions: facets of one plane of a part are one, and all facets of a part with normals
/// of its own for shading. Lines of mirror images are told apart from those of what they are images
/// of.

#include <vector>

#include "alhazen/imaging/drawing/drawing.h"
#include "alhazen/renderers/beam_tracing/beam_tree.h"

namespace alhazen {

/// A line in the window.
struct BeamOutline {
    LineStyle style = LineStyle::Crease;
    LatticeLoop points;
    bool closed = true;
};
/// Creases first.
[[nodiscard]] std::vector<BeamOutline> beam_outlines(const BeamScene& scene, const BeamTree& tree);

}  // namespace alhazen
