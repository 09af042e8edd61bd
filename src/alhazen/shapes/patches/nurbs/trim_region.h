#pragma once
/// The part of a parameter plane that trimming loops keep: the points inside an odd number of
/// loops.
///
/// Source: Martin, Cohen, Fish and Shirley, "Practical Ray Tracing of Trimmed NURBS Surfaces",
/// Journal of Graphics Tools 5(1), 2000 (parity along a half-line); Nishita, Sederberg and
/// Kakimoto, "Ray Tracing Trimmed Rational Surface Patches", SIGGRAPH 1990 (a curve whose hull does
/// not contain the point counts by its ends).
/// Differs: curves whose hull contains the point are halved, down to chords whose side is an exact
/// sign; arcs are listed by strips of v.
/// Conventions: parity is taken along the half-line from the point towards greater u. Neighbouring
/// arcs share their end point exactly, so that no point lies between them. A point on the border is
/// inside or outside, consistently.
/// Complexity: O(arcs over the strip) for a point, and O(log 1/distance) for an arc around it.

#include <span>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"
#include "alhazen/shapes/patches/nurbs/trim_arcs.h"

namespace alhazen {

class TrimRegion {
  public:
    /// Precondition: `check_trim_loops` reports nothing.
    explicit TrimRegion(std::span<const TrimLoop> loops);

    [[nodiscard]] bool contains(const Vec2& p) const;

    enum class Cover { None, Some, All };
    /// How much of the rectangle is in the region; Some if uncertain.
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
    std::vector<std::uint32_t> strip_starts_;  ///< [strip] into strip_arcs_, and one more
    std::vector<std::uint32_t> strip_arcs_;
};

/// Reports curves with an invalid degree, knots, points or weights, and loops that are open,
/// self-intersecting or intersect each other. `size`: of the domain, to which gaps are relative.
void check_trim_loops(FieldChecks& checks, std::span<const TrimLoop> loops, const Vec2& size);

}  // namespace alhazen
