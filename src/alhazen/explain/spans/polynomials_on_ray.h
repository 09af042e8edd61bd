#pragma once
/// The equations of algebraic surfaces along a ray, as polynomials in t, and their real roots.
///
/// Source: Hanrahan, "Ray Tracing Algebraic Surfaces", SIGGRAPH 1983 (substitution of the line into
/// the equation); Farouki and Rajan, "Algorithms for polynomials in Bernstein form", Computer Aided
/// Geometric Design 5, 1988 (the coefficients shown).
/// Differs: coefficients are for display and not certified; roots are the crossings that the ray
/// test of the primitive reports, without its caps, and all other changes of sign in the range, as
/// of a part that its clip cuts off.
/// Conventions: spheres, all quadrics with a form (shapes/quadrics/quadric_line.h), tori and
/// algebraic surfaces, placed or inside instances and solids. `expression` is in the local frame of
/// the shape; p(u) = sum b[i] C(n, i) (1 - u)^(n - i) u^i with u = (t - from) / (to - from).

#include <string>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/session/load.h"

namespace alhazen {

struct PolynomialOnRay {
    std::string shape, part;
    std::string expression;  ///< equation in x, y and z
    int degree = 0;
    /// Range of t around the bounds of the primitive, from 0 on; without roots beyond the bounds.
    double from = 0, to = 0;
    std::vector<double> bernstein;  ///< degree + 1 coefficients
    std::vector<double> roots;      ///< ascending; all in the range
};

/// The polynomials of at most 24 primitives whose bounds the ray meets, nearest first.
[[nodiscard]] std::vector<PolynomialOnRay> polynomials_on_ray(const LoadedScene& loaded,
                                                              const Ray& ray);

}  // namespace alhazen
