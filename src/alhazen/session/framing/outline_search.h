#pragma once
/// Finds the farthest point of a solid in a direction by rays across the direction.
///
/// Derivation: rays perpendicular to the direction, in rows from the end of the box inward. From
/// the hits of the first row a window climbs the outline, and shrinks once it contains the top.

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

class OutlineSearch {
  public:
    /// The parameter of a hit of the ray, if any. Called from several threads.
    using Shoot = std::function<std::optional<double>(const Ray& ray)>;

    /// `box` contains the solid.
    OutlineSearch(const Box3& box, const Vec3& direction, Shoot shoot);

    /// The point with the largest dot(direction, point), if that is larger than `least`.
    [[nodiscard]] std::optional<Vec3> farthest(double least) const;

  private:
    /// The columns of a row whose rays hit, and the points hit.
    struct Row {
        std::vector<double> columns;
        std::vector<Vec3> points;
    };
    /// The highest point so far.
    struct Top {
        double column, height;
        Vec3 point;
    };
    [[nodiscard]] Row shoot_row(double height, const std::vector<double>& columns) const;
    /// Climbs from `top` by windows that reach `room` above and `reach` to each side.
    [[nodiscard]] Top climb(Top top, double reach, double room) const;

    Shoot shoot_;
    Vec3 center_;
    double scale_;              ///< length of the direction
    Vec3 up_, across_, along_;  ///< unit vectors; `up_` is the direction
    double reach_up_, reach_across_, reach_along_;
};

}  // namespace alhazen
