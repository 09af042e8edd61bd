#pragma once
/// A convex polyhedron that can be cut by planes: the cell of a BSP tree's node.
///
/// Source: Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 17(1), 1974, face by face.
/// Differs: computes the area of a cut without building the parts: the vector areas of a closed
/// surface sum to zero, which gives that of the cut from the faces on one side.
/// Conventions: a plane is normal . p = offset; its lower side is below the offset. Coordinates are
/// of order 1, so that squares of areas neither over- nor underflow. Remnants of a face in the
/// cutting plane due to rounding have no area.

#include <cstdint>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

class ConvexCell {
  public:
    explicit ConvexCell(const Box3& box);

    /// Area of the whole surface.
    [[nodiscard]] double area() const { return area_; }
    [[nodiscard]] double volume() const;
    /// Range of normal . p over the points of the cell.
    [[nodiscard]] Interval extent(const Vec3& normal) const;

    struct Areas {
        double lower = 0, upper = 0;
    };
    /// Surface areas of both parts, including the cut.
    [[nodiscard]] Areas areas_of_parts(const Vec3& normal, double offset) const;
    /// The part below the plane; without faces if it is empty.
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
