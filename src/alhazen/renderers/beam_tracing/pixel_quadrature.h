#pragma once
/// The mean of a colour over a polygon within a pixel.
///
/// Source: Lyness, "Notes on the Adaptive Simpson Quadrature Routine", Journal of the ACM 16, 1969
/// (the difference to a rule of lower order decides about division).
/// Differs: over polygons. The lower rule is the colour in the middle of the polygon, the higher
/// one the mean of four points that match its moments up to the second. If their difference, times
/// the area, exceeds the requested error, the polygon is cut in four, each with half of that error.
/// Conventions: coordinates in pixels from the centre of the pixel; a pixel has the area 1. Loops
/// have the inside on their left. The difference of the rules bounds the error of the higher one if
/// the colour is smooth; details smaller than the distance of the points may be missed, but for
/// those of textures.
/// Complexity: five colours if that is sufficient, at most 5 (1 + 4 + ... + 4^kDeepest).

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/renderers/beam_tracing/pixel_polygon.h"

namespace alhazen {

/// Area, centroid, and the points of the rule.
struct PixelRule {
    double area = 0;
    Vec2 middle;
    std::array<Vec2, 4> points;
    Vec2 lo, hi;  ///< box around the polygon
};
[[nodiscard]] PixelRule rule_of(const PixelPolygon& polygon);

class PixelQuadrature {
  public:
    static constexpr int kDeepest = 6;

    /// `error`: of a pixel's colour.
    explicit PixelQuadrature(double error) : error_(error) {}

    /// `shade(at, width)` is the colour of a point, textures filtered over that width: the
    /// part's, so that no detail of a mipmapped texture lies between its points.
    template <class Shade>
    [[nodiscard]] Rgb mean(const PixelPolygon& polygon, const Shade& shade) const {
        const PixelRule rule = rule_of(polygon);
        if (!(rule.area > kLeastArea)) return shade(rule.middle, width_of(rule));
        return (1.0 / rule.area) * integral(polygon, rule, error_, 0, shade);
    }

  private:
    /// Smaller parts are shaded once.
    static constexpr double kLeastArea = 1e-6;

    [[nodiscard]] static double width_of(const PixelRule& rule) {
        return std::max(rule.hi.x - rule.lo.x, rule.hi.y - rule.lo.y);
    }

    template <class Shade>
    [[nodiscard]] Rgb integral(const PixelPolygon& polygon, const PixelRule& rule, double error,
                               int depth, const Shade& shade) const {
        const double width = width_of(rule);
        const Rgb lower = shade(rule.middle, width);
        Rgb sum;
        for (const Vec2& p : rule.points) sum += 0.25 * shade(p, width);
        const Rgb d = sum - lower;
        const double off = std::max({std::abs(d.r), std::abs(d.g), std::abs(d.b)});
        // NaN does not cause a division.
        if (!(off * rule.area > error) || depth == kDeepest) return rule.area * sum;
        const Vec2 middle = 0.5 * (rule.lo + rule.hi);
        Rgb result;
        for (int k = 0; k < 4; ++k) {
            const bool right = (k & 1) != 0, upper = (k & 2) != 0;
            const PixelPolygon part =
                polygon.within({right ? middle.x : rule.lo.x, upper ? middle.y : rule.lo.y},
                               {right ? rule.hi.x : middle.x, upper ? rule.hi.y : middle.y});
            const PixelRule of_part = rule_of(part);
            if (!(of_part.area > 0.0)) continue;
            result += integral(part, of_part, 0.5 * error, depth + 1, shade);
        }
        return result;
    }

    double error_;
};

}  // namespace alhazen
