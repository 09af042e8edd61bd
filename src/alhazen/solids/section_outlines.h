#pragma once
/// The curves in which a plane cuts the solids of a scene, as polylines within a tolerance.
///
/// Source: Lorensen and Cline, "Marching Cubes", SIGGRAPH 1987, in two dimensions (cells whose
/// edges a curve crosses); Douglas and Peucker, "Algorithms for the Reduction of the Number of
/// Points ...", Cartographica 10(2), 1973 (simplification).
/// Differs: no interpolation. Every corner of a polyline is a crossing of a line in the plane with
/// the solid, as exact as a ray's. If the curve leaves the chord between two corners, a line across
/// the middle of the chord finds a third. A cell with the ends of more than two curves is split
/// into four.
/// Conventions: points are in the plane's coordinates (PlaneFrame: right, up), from its origin.
/// Outlines are closed, with the solid on their left. Features narrower than a grid cell may be
/// missed; the grid has `cells` along the longer side. Can be interrupted (base/interruption.h).

#include <vector>

#include "alhazen/solids/isolated_solid.h"
#include "alhazen/solids/solid_measures.h"

namespace alhazen {

struct OutlineOptions {
    int cells = 256;  ///< along the longer side of the region that the plane may cut
    /// Largest distance between polyline and curve, scene units.
    double tolerance = 1e-4;
};

using Polyline = std::vector<Vec2>;  ///< closed: the last point joins the first

struct SectionOutlines {
    std::vector<Polyline> loops;
    /// Cells whose curves could not be separated, and unmatched ends of curves: places where the
    /// outline may be wrong.
    std::uint64_t unresolved = 0;

    /// Enclosed area without holes.
    [[nodiscard]] double area() const;
};

/// The smallest tolerance for solids in the box. It is far above the rounding of crossings, below
/// which chords would be split endlessly.
[[nodiscard]] double least_tolerance(const Box3& box);

/// Traces the outlines of `solid`. Throws Error (Usage) for a tolerance below the least one, fewer
/// than one cell, and unbounded solids.
[[nodiscard]] SectionOutlines trace_section(const Measurable& solid, const PlaneFrame& frame,
                                            const OutlineOptions& options);

}  // namespace alhazen
