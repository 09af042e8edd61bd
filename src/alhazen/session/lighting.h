#pragma once
/// The lights of a scene by name, and the scene with some lights switched off or changed, or with
/// another environment.
///
/// Conventions: lights are those of the description, in its order, then the emitting materials.
/// Materials of seen lights (seen_lights.h) are not listed; they are switched with their light.
/// Names are unique. A light that is off stays in the scene with intensity 0, so that the indices
/// of lights do not change.

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
    Rgb color;  ///< colour, radiance, ambient term or emission, whichever it has
    std::vector<ExtentSize> sizes;  ///< of a light with extent
};
[[nodiscard]] std::vector<NamedLight> light_choices(const SceneDescription& description);

/// Changes of one light relative to the file; only fields that the light has. One change per light.
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
    /// Replaces the environment of the scene; an entry of `environments()`, or empty. Only for
    /// physically based renderers.
    std::string environment;
    /// The environment that `make_environment(environment)` returns; null for "none".
    std::shared_ptr<const Environment> surroundings;

    [[nodiscard]] bool is_that_of_the_scene() const {
        return off.empty() && changes.empty() && environment.empty();
    }
};

/// The changes of surfaces that are parts of the scene, without their colours: the input of
/// `with_moved_surfaces`. Throws as `with_lighting`.
[[nodiscard]] std::vector<LightChange> surface_changes(const SceneDescription& description,
                                                       const std::vector<LightChange>& changes);

/// The scene with these surfaces in their changed places; builds its aggregate and shares or copies
/// the rest. Can be interrupted (interruption.h). Throws as `with_lighting` and `build_aggregate`.
[[nodiscard]] LoadedScene with_moved_surfaces(const LoadedScene& loaded,
                                              const std::vector<LightChange>& changes,
                                              const CompileOptions& options);

/// The scene with a lighting. All geometry is shared: `scene` must have the surfaces of its lights
/// in their changed places (`with_moved_surfaces`), `description` is that of the file. Throws Error
/// (Usage) for an unknown light, with the list of known ones, for a light changed more than once,
/// for a field that the light does not have, and for invalid numbers.
[[nodiscard]] Scene with_lighting(const Scene& scene, const SceneDescription& description,
                                  const Lighting& lighting);

/// The changed lights as blocks of the native format; for a material, a comment line with its
/// emission. Throws as `with_lighting`.
[[nodiscard]] std::string changed_light_blocks(const SceneDescription& description,
                                               const std::vector<LightChange>& changes);

}  // namespace alhazen
