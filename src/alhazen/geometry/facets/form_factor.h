#pragma once
/// Form factors: the part of the light leaving one polygon that another receives, with occluders.
///
/// Source: Lambert, "Photometria", 1760 (the contour formula: a sum over the edges of a polygon);
/// Nishita and Nakamae, "Continuous Tone Representation of Three-Dimensional Objects Taking Account
/// of Shadows and Interreflection", SIGGRAPH 1985 (its use on visible parts); van Oosterom and
/// Strackee, "The Solid Angle of a Plane Triangle", IEEE Transactions on Biomedical Engineering
/// BME-30, 1983; Radon, "Zur mechanischen Kubatur", Monatshefte fuer Mathematik 52, 1948 (seven
/// points on a triangle, exact to degree 5).
/// Differs: from a point the factor is exact; between polygons it is integrated over one of them,
/// and triangles are subdivided where the rule and its four quarters differ most.
/// Conventions: loops are convex. A polygon emits and receives on the side from which it runs
/// counter-clockwise. All facets of the tree occlude, except those in the plane of either polygon.
/// Threads: any number.

#include <cstdint>

#include "alhazen/geometry/facets/visible_parts.h"

namespace alhazen {

/// The solid angle of a convex loop, positive if it runs counter-clockwise seen from the point.
[[nodiscard]] double solid_angle(const Vec3& point, std::span<const Vec3> loop);

/// The form factor from a surface element at the point to an unoccluded convex loop. Parts below
/// the horizon of the element do not count. `normal`: unit.
[[nodiscard]] double form_factor(const Vec3& point, const Vec3& normal, std::span<const Vec3> loop);

/// The form factor to the part of the loop that the facets of the tree do not occlude.
[[nodiscard]] double form_factor(const FacetTree& tree, const Vec3& point, const Vec3& normal,
                                 std::span<const Vec3> loop, FacetWalkCounts* counts = nullptr);

struct FormFactorOptions {
    double tolerance = 1e-5;              ///< of the factor, absolute
    std::uint64_t most_points = 200'000;  ///< points on the receiver, at most
};

struct FormFactor {
    double value = 0;  ///< part of the light leaving the receiver that meets the other polygon
    double error = 0;  ///< estimate: sum of the absolute differences by subdivision
    std::uint64_t points = 0;
    FacetWalkCounts walk;

    [[nodiscard]] bool converged(const FormFactorOptions& options) const {
        return error <= options.tolerance;
    }
};

/// The mean over `from` of the form factor to `to`. By reciprocity the opposite factor is this one
/// times the ratio of their areas.
[[nodiscard]] FormFactor form_factor(const FacetTree& tree, std::span<const Vec3> from,
                                     std::span<const Vec3> to,
                                     const FormFactorOptions& options = {});

}  // namespace alhazen
