#pragma once
/// Division of B-splines into their Bezier pieces by knot insertion.
///
/// Source: Boehm, "Inserting New Knots into B-Spline Curves", Computer-Aided Design 12(4), 1980;
/// Piegl and Tiller, "The NURBS Book", 2nd ed., Springer, 1997, equation 5.15.
/// Conventions: n control points of degree p have n + p + 1 ascending knots; the domain is
/// [knots[p], knots[n]]. Internal to shapes/patches.

#include <string>
#include <vector>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

using HomogeneousRow = std::vector<HomogeneousPoint>;

/// Inserts every knot of the domain until its multiplicity is at least the degree: each non-empty
/// span is then a Bezier curve.
void insert_all_knots(std::vector<double>& knots, HomogeneousRow& row, int degree);

/// A span of the domain, and the index of its first control point.
struct KnotSpan {
    double lo, hi;
    std::size_t first;
};
/// The non-empty spans of [lo, hi]. Precondition: the knots are those of `insert_all_knots`.
[[nodiscard]] std::vector<KnotSpan> knot_spans(const std::vector<double>& knots, int degree,
                                               double lo, double hi);

/// Reports each knot that is not finite or descends, an empty domain, and each inner knot with a
/// multiplicity above the degree. False if anything was reported.
bool check_knots(FieldChecks& checks, const std::string& name, const std::vector<double>& knots,
                 std::uint32_t degree);

}  // namespace alhazen
