#pragma once
/// The curves in which a plane cuts the solids of a scene, as polylines within a stated distance of
/// them.
///
/// Source: Lorensen and Cline, "Marching Cubes", SIGGRAPH 1987, in two dimensions (cells whose
/// edges a curve crosses); Douglas and Peucker, "Algorithms for the Reduction of the Number of
/// Points ...", Cartographica 10(2), 1973 (simplification).
/// Differs: nothing is interpolated. Every corner of a polyline is a crossing of a line in the
/// plane with the solid, as exact as any ray's. Where the curve leaves the chord between two of
/// them, a line across the middle of the chord finds a third. A cell that more than two curves'
/// ends pass is split in four. Conventions: points are in the plane's own coordinates (PlaneFrame:
/// right, up), from its origin. Outlines of a solid are closed, the solid on their left. Features
/// narrower than a cell of the grid may be missed; the grid has `cells` along the longer side.

#include <vector>

#include "alhazen/solids/isolated_solid.h"
#include "alhazen/solids/solid_measures.h"

namespace alhazen {

struct OutlineOptions {
    int cells = 256;  ///< along the longer side of what the plane may cut
    /// Largest distance of a polyline from the curve, scene units.
    double tolerance = 1e-4;
};

using Polyline = std::vector<Vec2>;  ///< closed: the last point joins the first

struct SectionOutlines {
    std::vector<Polyline> loops;
    /// Cells in which the curves could not be told apart, and ends of curves that met no other:
    /// there the outline may be wrong.
    std::uint64_t unresolved = 0;

    /// What the loops enclose, holes taken away.
    [[nodiscard]] double area() const;
};

/// The smallest tolerance for solids in the box: chords are split until they are as near to the
/// curve, so it must be far above the rounding of crossings, or they are split for ever.
[[nodiscard]] double least_tolerance(const Box3& box);

/// Throws Error (Usage) for a tolerance below the least one, less than one cell, and a solid that
/// is not bounded.
[[nodiscard]] SectionOutlines trace_section(const Measurable& solid, const PlaneFrame& frame,
                                            const OutlineOptions& options);

}  // namespace alhazen
