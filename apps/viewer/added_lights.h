#pragma once
/// What `complete_view` adds to a scene without lights or surroundings, for each camera and kind of
/// renderer, as `alhazen render` does for the chosen ones.
///
/// Conventions: a scene is completed once, for its first camera and a renderer that is not
/// physically based. The added light is the last one of the scene and of its description.

#include <optional>
#include <string>
#include <vector>

#include "alhazen/session/lighting.h"

namespace alhazen::viewer {

struct AddedLights {
    bool any = false;               ///< a light was added
    bool follows_light = true;      ///< physically based renderers have it as well
    bool studio = false;            ///< physically based renderers see a studio around the scene
    Rgb background;                 ///< of the scene before
    std::vector<Light> of_cameras;  ///< [camera] its headlight; empty if another light was added

    /// True if the scene is shown without the added light.
    [[nodiscard]] bool is_left_out(bool renderer_follows_light, const Lighting& lighting) const {
        return any && renderer_follows_light && (!follows_light || !lighting.environment.empty());
    }
    /// True if a camera has another headlight than the first.
    [[nodiscard]] bool is_another(std::size_t camera) const {
        return camera > 0 && camera < of_cameras.size();
    }
    /// The headlight of a view; none if it is that of the first camera, or if another light was
    /// added.
    [[nodiscard]] std::optional<Light> of_view(const Camera& view) const;
};

/// Completes a scene that has an aggregate. Throws as `complete_view`.
[[nodiscard]] AddedLights complete(LoadedScene& loaded);

/// The lights and materials of a description with another headlight, for the functions of
/// lighting.h.
[[nodiscard]] SceneDescription lights_of(const SceneDescription& description,
                                         const Light& headlight);

/// The scene as a view and a renderer show it. As `with_lighting` otherwise.
[[nodiscard]] Scene with_lighting(const Scene& scene, const SceneDescription& description,
                                  const Lighting& lighting, const AddedLights& added,
                                  const Camera& view, bool renderer_follows_light);

}  // namespace alhazen::viewer
