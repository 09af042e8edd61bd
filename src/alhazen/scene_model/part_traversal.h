#pragma once
/// The parts of a description as the scene compiler numbers and places them.
///
/// Conventions: parts are numbered through all objects in the order of the description, so a number
/// identifies one part. An object that is used once, as a group without an accelerator of its own,
/// is dissolved: its parts count as parts of the object that uses it.

#include <cstdint>
#include <functional>
#include <vector>

#include "alhazen/geometry/ray_mask.h"
#include "alhazen/math/affine.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Numbers of parts and uses of objects.
class PartNumbers {
  public:
    explicit PartNumbers(const SceneDescription& description);

    /// The number of the first part of an object; the others follow it.
    [[nodiscard]] std::uint32_t first_of(std::size_t object) const { return first_[object]; }
    /// How many parts refer to an object.
    [[nodiscard]] std::uint32_t uses_of(std::size_t object) const { return uses_[object]; }
    /// True if the parts of an object count as parts of the one that uses it.
    [[nodiscard]] bool is_dissolved(std::size_t object) const;

  private:
    const SceneDescription& d_;
    std::vector<std::uint32_t> first_, uses_;  ///< [object]
};

/// A shape or mesh of a description in its place.
struct WorldPart {
    const Part& part;
    Affine world_from_part;
    std::uint32_t number;  ///< of the part
    std::uint32_t
        instance;        ///< the number of the outermost part that keeps an object; else `number`
    RayMask visible_to;  ///< of the part and all objects around it; never empty
};

/// Visits the shapes and meshes below the root in order, but those that no ray of `rays` sees.
/// `solid` is called for each object of constructive geometry, whose parts are not visited.
void visit_parts(const SceneDescription& description, RayMask rays,
                 const std::function<void(const WorldPart&)>& each,
                 const std::function<void(const ObjectDescription&)>& solid);

}  // namespace alhazen
