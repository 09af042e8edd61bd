#pragma once
/// A convex polyhedron that planes cut in two: the cell of a node of a BSP tree.
///
/// Source: Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 17(1), 1974, face by face.
/// Differs: the area of a cut is found without building the parts: the vector areas of a closed
/// surface sum to zero, so that of the cut is what the faces on one side of it lack.
/// Conventions: a plane is normal . p = offset, its lower side what is below. Coordinates are of
/// the order of 1, so that squares of areas neither overflow nor vanish. What rounding leaves of a
/// face in the plane counts as no area.

#include <cstdint>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

class ConvexCell {
  public:
    explicit ConvexCell(const Box3& box);

    /// Of the whole surface.
    [[nodiscard]] double area() const { return area_; }
    [[nodiscard]] double volume() const;
    /// Range of normal . p over the points of the cell.
    [[nodiscard]] Interval extent(const Vec3& normal) const;

    struct Areas {
        double lower = 0, upper = 0;
    };
    /// The surfaces of both parts, the cut included.
    [[nodiscard]] Areas areas_of_parts(const Vec3& normal, double offset) const;
    /// Without faces where there is nothing.
    [[nodiscard]] ConvexCell lower_part(const Vec3& normal, double offset) const;
    [[nodiscard]] ConvexCell upper_part(const Vec3& normal, double offset) const {
        return lower_part(-normal, -offset);
    }

  private:
    ConvexCell() = default;
    void add_face(const std::vector<Vec3>& points);
    void close(std::vector<Vec3> rim, const Vec3& normal);

    std::vector<Vec3> points_;              ///< face after face, counterclockwise from outside
    std::vector<std::uint32_t> starts_{0};  ///< [face], and one more
    double area_ = 0;
};

}  // namespace alhazen
