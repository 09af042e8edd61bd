#pragma once
/// The part of a parameter plane that trimming loops keep: points inside of an odd number of them.
///
/// Source: Martin, Cohen, Fish and Shirley, "Practical Ray Tracing of Trimmed NURBS Surfaces",
/// Journal of Graphics Tools 5(1), 2000 (parity of a half-line); Nishita, Sederberg and Kakimoto,
/// "Ray Tracing Trimmed Rational Surface Patches", SIGGRAPH 1990 (curves outside of whose hull the
/// point lies count by their ends).
/// Differs: curves are halved where the hull holds the point, down to chords whose side is an exact
/// sign; a list of arcs for each strip of v.
/// Conventions: a loop counts where the half-line towards greater u from the point crosses it. An
/// end point shared by two arcs is one value, thus no point is between them. A point on the border
/// is in or out, always the same.
/// Complexity: O(arcs over the strip) for a point, and O(log 1/distance) for an arc around it.

#include <span>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"
#include "alhazen/shapes/patches/nurbs/trim_arcs.h"

namespace alhazen {

class TrimRegion {
  public:
    /// Precondition: `check_trim_loops` finds nothing.
    explicit TrimRegion(std::span<const TrimLoop> loops);

    [[nodiscard]] bool contains(const Vec2& p) const;

    enum class Cover { None, Some, All };
    /// How much of the rectangle is in the region; Some where that is not certain.
    [[nodiscard]] Cover cover(const Vec2& lo, const Vec2& hi) const;

    [[nodiscard]] std::size_t bytes() const;

  private:
    struct StripRange {
        std::size_t first, last;
    };
    [[nodiscard]] StripRange strips_of(double v_lo, double v_hi) const;
    [[nodiscard]] std::span<const std::uint32_t> arcs_over(std::size_t strip) const;

    std::vector<TrimArc> arcs_;
    double v_lo_ = 0, v_hi_ = 0;
    std::vector<std::uint32_t> strip_starts_;  ///< [strip], into strip_arcs_; one more
    std::vector<std::uint32_t> strip_arcs_;
};

/// Adds findings: curves without a good degree, knots, points or weights; loops that are open,
/// cross themselves or one another. `size`: of the domain, the measure of a gap.
void check_trim_loops(FieldChecks& checks, std::span<const TrimLoop> loops, const Vec2& size);

}  // namespace alhazen
