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

/// Inserts every knot of the domain until its multiplicity is at least the degree: then each span
/// that is not empty is a Bezier curve.
void insert_all_knots(std::vector<double>& knots, HomogeneousRow& row, int degree);

/// A span of the domain and the first of its control points.
struct KnotSpan {
    double lo, hi;
    std::size_t first;
};
/// The spans of [lo, hi] that are not empty. Precondition: `insert_all_knots` made the knots.
[[nodiscard]] std::vector<KnotSpan> knot_spans(const std::vector<double>& knots, int degree,
                                               double lo, double hi);

/// Adds a finding for each knot that is not finite or falls, for an empty domain, and for an inner
/// knot that repeats more often than the degree. False after one.
bool check_knots(FieldChecks& checks, const std::string& name, const std::vector<double>& knots,
                 std::uint32_t degree);

}  // namespace alhazen
