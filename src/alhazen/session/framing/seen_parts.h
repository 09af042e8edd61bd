#pragma once
/// The outermost points of what a camera can see of a scene.
///
/// Conventions: endless parts are left out, and parts, instances and triangles that eye rays do not
/// see. Corners of triangles are exact. Shapes whose `extent` is tight are too, to about a
/// millionth of their size. All others (solids of CSG, blobs, clipped quadrics, ...) are found by
/// rays: what is thinner than 1/256 of the part may be missed.
/// Complexity: a pass over all primitives when made. A query looks into the parts whose boxes reach
/// farther than what is found already.

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

    /// Holds all of them; empty where there are none.
    [[nodiscard]] const Box3& box() const { return root_->box; }
    /// The point with the largest dot(direction, point), if that is larger than `least`.
    [[nodiscard]] std::optional<Vec3> farthest(const Vec3& direction, double least) const;

  private:
    enum class Sort : std::uint8_t { TightShape, OtherShape, Triangles, Instance, Solid };
    struct Group;
    struct Part {
        Box3 box;             ///< in the frame of the group
        std::uint32_t first;  ///< id of the primitive; of triangles and instances, their index
        std::uint32_t count;
        Sort sort;
        const Group* inner;  ///< of an instance
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
