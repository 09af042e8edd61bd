#pragma once
/// Lines of a drawing: the borders of planes and objects in the picture.
///
/// Source: edges follow from the visible regions, as in Weiler and Atherton, "Hidden Surface
/// Removal Using Polygon Area Sorting", SIGGRAPH 1977, section 6 (outlines of polygons that were
/// cut). Conventions: facets in one plane of a part are merged, and so are all facets of a part
/// with shading normals. Lines of mirror images are distinguished from those of the mirrored
/// objects.

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
/// Creases come first.
[[nodiscard]] std::vector<BeamOutline> beam_outlines(const BeamScene& scene, const BeamTree& tree);

}  // namespace alhazen
