#pragma once
/// Boxes of the objects of a scene description, before it is compiled.
///
/// Source: BRL-CAD, manual page of `rt`: the view is fitted to the box of the model. Differs:
/// nothing. Conventions: of things side by side and of unions only the bounded ones count; an
/// intersection lies within the box of each of its parts, a difference in that of its first.

#include <optional>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

class BrlcadBounds {
  public:
    /// The scene must not change afterwards, and no object may contain itself.
    explicit BrlcadBounds(const SceneDescription& scene);
    [[nodiscard]] Box3 of(ObjectIndex object);
    /// In the frame of the object that owns the part.
    [[nodiscard]] Box3 of(const Part& part);

  private:
    const SceneDescription& scene_;
    std::vector<std::optional<Box3>> objects_, meshes_;
};

}  // namespace alhazen
