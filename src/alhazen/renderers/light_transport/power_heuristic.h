#pragma once
/// The power heuristic: the weight of a sample that another strategy could have drawn.
///
/// Source: Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering",
/// SIGGRAPH 1995, equation 15, with the exponent 2.

namespace alhazen {

/// `own`, `other`: densities of one sample each; `own` above 0.
[[nodiscard]] inline double power_heuristic(double own, double other) {
    const double ratio = other / own;
    return 1.0 / (1.0 + ratio * ratio);
}

}  // namespace alhazen
