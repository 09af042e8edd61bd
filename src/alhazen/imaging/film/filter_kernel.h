#pragma once
/// Filter kernels by name, and their importance sampling: a sample drawn in proportion to the
/// kernel belongs to a single pixel, so that tiles need no borders.
///
/// Source: Ernst, Stamminger and Greiner, "Filter Importance Sampling", IEEE Symposium on
/// Interactive Ray Tracing 2006; Mitchell and Netravali, "Reconstruction Filters in Computer
/// Graphics", SIGGRAPH 1988; Harris, "On the Use of Windows for Harmonic Analysis ...", Proc. IEEE
/// 66(1), 1978 (Blackman-Harris); Duchon, "Lanczos Filtering in One and Two Dimensions", J. Appl.
/// Meteorology 18(8), 1979.
/// Differs: kernels are sampled exactly, as chains of kCells linear pieces.
/// Conventions: kernels are products of a function of x and one of y, in pixels from the centre of
/// the pixel; 0 beyond the radius. Their scale is arbitrary.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// A kernel's name, a description in one line and its functions.
struct FilterEntry {
    const char* name;
    const char* description;
    double radius;  ///< default radius, in pixels
    /// The value at x. Precondition: |x| <= radius.
    double (*value)(double x, double radius);
    /// The integral of the value from 0 to x, |x| <= radius; null if it has no closed form.
    double (*integral)(double x, double radius);
};

/// The table of kernels. ADD A FILTER HERE (filter_kernel.cpp: one line).
[[nodiscard]] std::span<const FilterEntry> filters();
/// The kernel of a name; null for an unknown name.
[[nodiscard]] const FilterEntry* find_filter(const std::string& name);

/// A kernel prepared for sampling. Threads: all functions may be called from several threads.
class FilterKernel {
  public:
    static constexpr int kCells = 2048;

    /// Precondition: radius > 0.
    FilterKernel(const FilterEntry& entry, double radius);

    struct Drawn {
        Vec2 offset;  ///< from the centre of the pixel, in pixels
        double sign;  ///< sign of the kernel there: 1 or -1
    };
    /// Samples an offset whose density is proportional to the magnitude of the kernel; monotonic in
    /// both coordinates of `u`, in [0, 1).
    [[nodiscard]] Drawn draw(const Vec2& u) const {
        // The bits of `draw_one`, which computes exactly in this case.
        if (even_) return {{radius_ * (2.0 * u.x - 1.0), radius_ * (2.0 * u.y - 1.0)}, 1.0};
        const OneDrawn x = draw_one(u.x), y = draw_one(u.y);
        return {{x.offset, y.offset}, x.sign * y.sign};
    }
    /// Mean of the signs: the integral of the kernel over the integral of its magnitude.
    [[nodiscard]] double mean_sign() const { return mean_sign_ * mean_sign_; }
    [[nodiscard]] bool has_negative_lobes() const { return mean_sign_ < 1.0; }
    [[nodiscard]] double radius() const { return radius_; }

  private:
    struct OneDrawn {
        double offset, sign;
    };
    [[nodiscard]] OneDrawn draw_one(double u) const;

    struct Node {
        double share;  ///< cumulative part of the magnitude's integral, from the left
        double magnitude;
        double sign;  ///< sign in the cell to the right
    };

    double radius_;
    bool even_ = false;        ///< the kernel is 1 everywhere
    std::vector<Node> nodes_;  ///< one more than cells
    /// [floor(u kCells)]: a cell at or before that of u (Chen and Asau, "On Generating Random
    /// Variates from an Empirical Distribution", AIIE Transactions 6(2), 1974).
    std::vector<std::uint32_t> guide_;
    double mean_sign_ = 1.0;
};

}  // namespace alhazen
