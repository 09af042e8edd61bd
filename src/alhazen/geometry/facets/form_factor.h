#pragma once
/// Form factors: the share of the light leaving one polygon that another receives, with occluders.
///
/// Source: Lambert, "Photometria", 1760 (the contour formula: a sum over the edges of a polygon);
/// Nishita and Nakamae, "Continuous Tone Representation of Three-Dimensional Objects Taking Account
/// of Shadows and Interreflection", SIGGRAPH 1985 (its use on visible parts); van Oosterom and
/// Strackee, "The Solid Angle of a Plane Triangle", IEEE Transactions on Biomedical Engineering
/// BME-30, 1983; Radon, "Zur mechanischen Kubatur", Monatshefte fuer Mathematik 52, 1948 (seven
/// points on a triangle, exact to degree 5).
/// Differs: from a point the factor is exact; between polygons it is integrated over one of them,
/// and triangles of it are divided where the rule and its four quarters differ most.
/// Conventions: loops are convex. A polygon gives and receives on the side that it runs
/// counter-clockwise from. All facets of the tree hide; those in the plane of either polygon hide
/// nothing. Threads: any number.

#include <cstdint>

#include "alhazen/geometry/facets/visible_parts.h"

namespace alhazen {

/// The solid angle of a convex loop, positive where it runs counter-clockwise seen from the point.
[[nodiscard]] double solid_angle(const Vec3& point, std::span<const Vec3> loop);

/// The form factor from a surface element at the point to a convex loop that nothing hides. What
/// lies below the horizon of the element counts nothing. `normal`: unit.
[[nodiscard]] double form_factor(const Vec3& point, const Vec3& normal, std::span<const Vec3> loop);

/// The same to what the element sees of it past the facets of the tree.
[[nodiscard]] double form_factor(const FacetTree& tree, const Vec3& point, const Vec3& normal,
                                 std::span<const Vec3> loop, FacetWalkCounts* counts = nullptr);

struct FormFactorOptions {
    double tolerance = 1e-5;              ///< of the factor
    std::uint64_t most_points = 200'000;  ///< of the receiver
};

struct FormFactor {
    double value = 0;  ///< share of what leaves the receiver and meets the other polygon
    double error = 0;  ///< estimate: sum of the differences that division made, with its sign lost
    std::uint64_t points = 0;
    FacetWalkCounts walk;

    [[nodiscard]] bool converged(const FormFactorOptions& options) const {
        return error <= options.tolerance;
    }
};

/// The mean over `from` of the form factor to `to`. By reciprocity the factor the other way is this
/// one times the ratio of their areas.
[[nodiscard]] FormFactor form_factor(const FacetTree& tree, std::span<const Vec3> from,
                                     std::span<const Vec3> to,
                                     const FormFactorOptions& options = {});

}  // namespace alhazen
