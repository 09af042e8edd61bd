#pragma once
/// A convex polyhedron that can be cut by planes: the cell of a BSP tree's node.
///
/// Source: Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 17(1), 1974, face by face.
/// Differs: finds the area of a cut without building the parts: the vector areas of a closed
/// surface sum to zero, so that of the cut is what the faces on one side lack.
/// Conventions: a plane is normal . p = offset; its lower side is below the offset. Coordinates are
/// of the order of 1, so that squares of areas neither over- nor underflow. Remains of a face in
/// the cutting plane due to rounding count as no area.

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
    /// The part below the plane; without faces when it is empty.
    [[nodiscard]] ConvexCell lower_part(const Vec3& normal, double offset) const;
    [[nodiscard]] ConvexCell upper_part(const Vec3& normal, double offset) const {
        return lower_part(-normal, -offset);
    }

  private:
    ConvexCell() = default;
    void add_face(const std::vector<Vec3>& points);
    void close(std::vector<Vec3> rim, const Vec3& normal);

    std::vector<Vec3> points_;              ///< face after face, counterclockwise from outside
    std::vector<std::uint32_t> starts_{0};  ///< [face], with an end
    double area_ = 0;
};

}  // namespace alhazen
