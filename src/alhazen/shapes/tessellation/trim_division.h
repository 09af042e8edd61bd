#pragma once
/// Division of trimming loops into chords within a tolerance on the surface, and of these at the
/// borders of the surface's patches.
///
/// Source: Rockwood, Heaton and Davis, "Real-time rendering of trimmed surfaces", SIGGRAPH 1989
/// (loops as polylines in the parameter plane, cut at the borders of patches).
/// Differs: a curve is halved until its distance from the chord, times the largest speed of the
/// surface around it, is small; straight parts are not divided.
/// Conventions: points within 2^-40 of the domain of a patch's border are on it. A point on a
/// border has the same bits for all patches that meet there.
/// Complexity: O(1 / sqrt(tolerance)) chords for a curve.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"
#include "alhazen/shapes/patches/nurbs/trim_region.h"

namespace alhazen {

struct TrimDivision {
    /// The chords within a patch, and the vertices of loops on its border.
    struct Part {
        std::vector<std::array<Vec2, 2>> chords;
        std::vector<Vec2> on_border;
    };
    std::vector<Part> parts;  ///< [piece]
    TrimRegion region;        ///< of the polylines
};

/// The loops of a surface of these pieces, each chord within `tolerance` of its curve in space,
/// measured along the surface. Nothing if there would be more than `max_chords`, or four times as
/// many parts of them. Precondition: no two pieces overlap.
[[nodiscard]] std::optional<TrimDivision> divided_trims(std::span<const TrimLoop> loops,
                                                        std::span<const BezierPiece> pieces,
                                                        double tolerance, std::uint64_t max_chords);

}  // namespace alhazen
