#pragma once
/// The outermost points of the parts that eye rays can see.
///
/// Conventions: unbounded parts are left out, as are parts, instances and triangles that eye rays
/// do not see. Corners of triangles are exact. Bezier patches are halved: exact to 1e-6 of their
/// height. Shapes whose `extent` is tight are exact to about a
/// millionth of their size. All others (CSG solids, blobs, clipped quadrics, ...) are found by
/// rays: features thinner than 1/256 of the part may be missed.
/// Complexity: the constructor visits all primitives. A query visits the parts whose boxes reach
/// beyond the best point so far.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "alhazen/primitives/aggregate.h"

namespace alhazen {

class SeenParts {
  public:
    /// `aggregate` must outlive the object.
    explicit SeenParts(const Aggregate& aggregate);

    /// The box of all seen parts; empty if there are none.
    [[nodiscard]] const Box3& box() const { return root_->box; }
    /// The point with the largest dot(direction, point), if that is larger than `least`.
    [[nodiscard]] std::optional<Vec3> farthest(const Vec3& direction, double least) const;

  private:
    enum class Sort : std::uint8_t { TightShape, Patches, OtherShape, Triangles, Instance, Solid };
    struct Group;
    struct Part {
        Box3 box;             ///< in the frame of the group
        std::uint32_t first;  ///< id of the primitive; index of the first triangle or the instance
        std::uint32_t count;
        Sort sort;
        const Group* inner;  ///< contents of an instance
    };
    /// The parts of an aggregate.
    struct Group {
        const Aggregate* aggregate;
        std::vector<Part> parts;
        Box3 box;
    };

    const Group* group_of(const Aggregate& aggregate);
    static void add(Part part, Group& group);
    static void add_triangles(const PrimitiveTable& table, Group& group);
    static std::optional<Vec3> farthest_of(const Group& group, const Vec3& direction, double least);
    static std::optional<Vec3> farthest_of(const Group& group, const Part& part,
                                           const Vec3& direction, double least);

    std::map<const Aggregate*, std::unique_ptr<Group>> groups_;
    const Group* root_;
};

}  // namespace alhazen
