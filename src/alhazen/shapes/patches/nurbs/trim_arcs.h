#pragma once
/// The curves of trimming loops, divided into arcs that are nearly straight.
///
/// Source: see bspline_pieces.h; de Casteljau's algorithm.
/// Conventions: an arc begins, bit for bit, where the one before it in its loop ends. Internal to
/// shapes/patches.

#include <span>
#include <utility>
#include <vector>

#include "alhazen/base/inline_vector.h"
#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"

namespace alhazen {

inline constexpr std::uint32_t kMaxTrimDegree = 15;
/// Largest gap between curves of a loop, relative to the domain; allows for rounding in files.
inline constexpr double kMaxTrimGap = 1e-6;

/// A rational Bezier curve of the parameter plane.
template <class Points>
struct TrimArcOf {
    Points points;    ///< z = 0
    Vec2 begin, end;  ///< the first and the last point, shared with the neighbours
    Vec2 lo, hi;      ///< box of the control points and of both ends
    std::uint32_t loop = 0;

    [[nodiscard]] bool straight() const { return points.size() == 2; }
};
using TrimArc = TrimArcOf<std::vector<HomogeneousPoint>>;
/// A part of an arc; a temporary of recursions, without heap allocation.
using TrimPiece = TrimArcOf<InlineVector<HomogeneousPoint, kMaxTrimDegree + 1>>;

/// The halves of an arc or a piece at the middle of the parameter; they share a point.
template <class Points>
[[nodiscard]] std::pair<TrimPiece, TrimPiece> halved(const TrimArcOf<Points>& arc);

/// First and last point of a curve. Precondition: valid degree, knots, points and weights.
[[nodiscard]] Vec2 begin_of(const TrimCurve& curve);
[[nodiscard]] Vec2 end_of(const TrimCurve& curve);

/// The arcs of all loops, in order, each within `flatness` of its chord. Gaps between curves are
/// closed.
[[nodiscard]] std::vector<TrimArc> trim_arcs(std::span<const TrimLoop> loops, double flatness);

/// A point where two loops, or a loop with itself, cross.
struct TrimCrossing {
    std::uint32_t first, second;
    Vec2 point;
};
/// The first crossing of each pair of loops. Complexity: sorted by u; linear if few arcs overlap.
[[nodiscard]] std::vector<TrimCrossing> trim_crossings(std::span<const TrimArc> arcs, double size);

}  // namespace alhazen
