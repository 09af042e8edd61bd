#pragma once
/// Bounding boxes of the objects of a scene description, before compilation.
///
/// Source: BRL-CAD, manual page of `rt`: the view is fitted to the box of the model.
/// Conventions: unbounded parts of an object and unbounded operands of a union are ignored. The box
/// of an intersection is the intersection of its operands' boxes; the box of a difference is that
/// of its first operand.

#include <optional>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

class BrlcadBounds {
  public:
    /// Preconditions: the scene does not change during the lifetime; no object contains itself.
    explicit BrlcadBounds(const SceneDescription& scene);
    [[nodiscard]] Box3 of(ObjectIndex object);
    /// The box in the frame of the object that has the part.
    [[nodiscard]] Box3 of(const Part& part);

  private:
    const SceneDescription& scene_;
    std::vector<std::optional<Box3>> objects_, meshes_;
};

}  // namespace alhazen
