#pragma once
/// The lights of a scene by name, and the scene with some of them off, changed, or with other
/// surroundings.
///
/// Conventions: lights are those of the description, in its order, then materials that emit, but
/// for those of seen lights (seen_lights.h), which are off with their light. Every name is another
/// one. A light that is off is one without intensity, so that numbers of lights stay what they are.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/session/load.h"
#include "alhazen/shading/lights/extent_handles.h"

namespace alhazen {

/// The light's name, or its kind and its number from 1 on: "spot light 2".
[[nodiscard]] std::string light_name(const SceneDescription& description, std::size_t light);

struct NamedLight {
    std::string name;
    std::string kind;  ///< "point light", "material that emits"
    std::optional<Vec3> position;
    std::optional<Vec3> direction;  ///< from the light into the scene, of any length
    Rgb color;                      ///< or radiance, ambient term, emission; what it has
    std::vector<ExtentSize> sizes;  ///< of a light with extent
};
[[nodiscard]] std::vector<NamedLight> light_choices(const SceneDescription& description);

/// What is other than in the file: fields that the choice has. Of a light there is one change.
struct LightChange {
    std::string name;
    std::optional<Vec3> position, direction;  ///< the direction of any length but 0
    std::optional<Rgb> color;
    std::vector<double> sizes{};  ///< as many as the choice has, or none

    friend bool operator==(const LightChange&, const LightChange&) = default;
};

struct Lighting {
    std::vector<std::string> off;  ///< names of `light_choices`
    std::vector<LightChange> changes;
    /// Instead of that of the scene; an entry of `environments()`, or empty. Only renderers that
    /// follow light are to be given one.
    std::string environment;
    /// Of `environment`, as `make_environment` makes it; null for "none".
    std::shared_ptr<const Environment> surroundings;

    [[nodiscard]] bool is_that_of_the_scene() const {
        return off.empty() && changes.empty() && environment.empty();
    }
};

/// Of the changes those of surfaces that are parts of the scene, without their colours: what
/// `with_moved_surfaces` builds. Throws as `with_lighting`.
[[nodiscard]] std::vector<LightChange> surface_changes(const SceneDescription& description,
                                                       const std::vector<LightChange>& changes);

/// The scene with these surfaces where they are then; its aggregate is built, all else is shared or
/// copied. Can be interrupted (interruption.h). Throws as `with_lighting` and `build_aggregate`.
[[nodiscard]] LoadedScene with_moved_surfaces(const LoadedScene& loaded,
                                              const std::vector<LightChange>& changes,
                                              const CompileOptions& options);

/// The scene with that lighting. All geometry is shared: `scene` has the surfaces of its lights
/// where they are to be, `description` is that of the file. Throws Error (Usage) for a light that
/// there is not, listing those that there are, for a light that is changed more than once, for a
/// field that a light has not, and for numbers that no light can have.
[[nodiscard]] Scene with_lighting(const Scene& scene, const SceneDescription& description,
                                  const Lighting& lighting);

/// Blocks of the native format of the lights that are changed, as they are then; a line of comment
/// with its emission for a material. Throws as `with_lighting`.
[[nodiscard]] std::string changed_light_blocks(const SceneDescription& description,
                                               const std::vector<LightChange>& changes);

}  // namespace alhazen
