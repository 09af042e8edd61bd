#pragma once
/// Areas of parts of a disc in closed form: beyond a line, within another disc, within a polygon.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 3 (the fraction of a cone
/// that a sphere, a plane, a polygon covers); the areas are those of elementary geometry.
/// Differs: computes first moments beside the areas, so that a part can be shaded at its centroid.
/// Conventions: discs are centred at the origin. Results are finite for finite input.
/// Complexity: O(1), or O(edges) for loops.

#include <span>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The area of the part of the disc of radius `r` beyond a line at the signed distance `h` from its
/// centre: the whole disc for h <= -r, 0 for h >= r.
[[nodiscard]] double segment_area(double r, double h);

/// The area common to two discs of radius `r` and `R` whose centres are `d` apart.
[[nodiscard]] double lens_area(double r, double R, double d);

/// A part of the unit disc.
struct DiscPart {
    double area = 0;    ///< pi for the whole disc
    Vec2 moment{0, 0};  ///< area times centroid

    DiscPart& operator+=(const DiscPart& o) {
        area += o.area;
        moment = moment + o.moment;
        return *this;
    }
    /// Precondition: area > 0.
    [[nodiscard]] Vec2 center() const { return (1.0 / area) * moment; }
};

/// The lens common to the unit disc and a disc of radius `R` whose centre is at distance `d` along
/// +x.
[[nodiscard]] DiscPart lens(double R, double d);

/// The signed part of the unit disc in the triangle of its centre and an edge: positive if the edge
/// runs counter-clockwise around the centre. The sum over the edges of loops is the part within
/// them.
[[nodiscard]] DiscPart edge_part(const Vec2& a, const Vec2& b);

/// The sum of `edge_part` over a closed loop.
[[nodiscard]] DiscPart loop_part(std::span<const Vec2> loop);

}  // namespace alhazen
