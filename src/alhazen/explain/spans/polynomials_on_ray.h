#pragma once
/// The polynomials in t that a ray makes of algebraic surfaces, and their real roots.
///
/// Source: Hanrahan, "Ray Tracing Algebraic Surfaces", SIGGRAPH 1983 (the line is put into the
/// equation); Farouki and Rajan, "Algorithms for polynomials in Bernstein form", Computer Aided
/// Geometric Design 5, 1988 (the coefficients shown).
/// Differs: coefficients are for being shown and are rounded as they come; roots are the crossings
/// that the ray test of the primitive reports, within its clip and without its caps.
/// Conventions: spheres, all quadrics with a form (shapes/quadrics/quadric_line.h), tori and
/// algebraic surfaces, placed or within instances and solids. `expression` is in the local frame of
/// the shape; p(u) = sum b[i] C(n, i) (1 - u)^(n - i) u^i with u = (t - from) / (to - from).

#include <string>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/session/load.h"

namespace alhazen {

struct PolynomialOnRay {
    std::string shape, part;
    std::string expression;  ///< in x, y and z
    int degree = 0;
    double from = 0, to = 0;        ///< of t: what lies around the bounds of the primitive
    std::vector<double> bernstein;  ///< degree + 1 coefficients
    std::vector<double> roots;      ///< ascending; t >= 0
};

/// Of the primitives whose bounds the ray meets, nearest first; at most `most`.
[[nodiscard]] std::vector<PolynomialOnRay> polynomials_on_ray(const LoadedScene& loaded,
                                                              const Ray& ray,
                                                              std::size_t most = 24);

}  // namespace alhazen
