#pragma once
/// Adds a camera that shows the whole scene, and a light, to a scene without them.
///
/// Derivation: the nearest eye whose view frustum contains a set of points: each side of the
/// frustum gives one linear bound on the position of the eye. The set grows by the farthest points
/// of the scene (seen_parts.h) beyond the sides of the current frustum until there are none.
/// Conventions: azimuth 0 sees the front. With Z up the front looks along +X and the azimuth turns
/// towards +Y; with Y up the front looks along +Z and the azimuth turns towards +X. The elevation
/// rises to the pole, 90 degrees. Boxes may have any size that is a normal number.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/scene/scene.h"

namespace alhazen {

/// Direction from the middle of the scene to the eye.
struct ViewAngles {
    double azimuth_deg = 30, elevation_deg = 20;
};

/// Parses "AZIMUTH,ELEVATION", as "30,20"; elevation in [-90, 90]. Throws Error (Usage).
[[nodiscard]] ViewAngles parse_view(const std::string& text);

/// The front for a box that is flat towards the front; otherwise from above and one side.
[[nodiscard]] ViewAngles default_view(const Box3& box, UpAxis up_axis);

/// The point of a scene with the largest dot(direction, point), if that is larger than `least`.
using FarthestPoint = std::function<std::optional<Vec3>(const Vec3& direction, double least)>;

/// A camera with a vertical field of view of 45 degrees. The scene is centred and fills the picture
/// in height or width except for 5 % on each side. `box` contains the scene; bounded and not empty.
[[nodiscard]] PerspectiveCamera framing_camera(const Box3& box, UpAxis up_axis,
                                               const ViewAngles& view, double aspect,
                                               const FarthestPoint& farthest);
/// The framing camera of the corners of the box.
[[nodiscard]] PerspectiveCamera framing_camera(const Box3& box, UpAxis up_axis,
                                               const ViewAngles& view, double aspect);

struct FramingOptions {
    std::optional<ViewAngles> view;  ///< if given: a framing camera is put before those of the file
    std::string camera;              ///< the selected camera; empty: the first
    double aspect = 4.0 / 3.0;       ///< width / height of the picture
    bool follows_light = false;   ///< of the renderer: environment and background are light sources
    bool nothing_around = false;  ///< neither lights nor surroundings are added
};

/// The light that `complete_view` adds: at the eye, so that visible points are not in shadow.
/// Without highlights: it would be a white spot on any glass that faces the eye. Of an orthographic
/// camera it comes from infinity: what lies behind the picture plane shades what is seen.
[[nodiscard]] Light headlight(const Camera& camera);

/// True if a material of the scene emits light, of more than `radiance` in a channel of its factor.
[[nodiscard]] bool glows(const Scene& scene, double radiance = 0);

/// True if `complete_view` adds a light, unless an environment or emitting materials are enough.
[[nodiscard]] bool lacks_light(const SceneDescription& description, const Scene& scene);

/// Adds a camera and a light to both if they have none, and a grey background if a light was added
/// and the file has no background. Formats whose unlit scenes are intentional get no light
/// (ImportConventions::headlight). For physically based renderers a background is the light
/// instead: only paths traced from the light would find a point light at the eye through water. A
/// scene with lights but no background gets dim grey surroundings if its format has none
/// (ImportConventions::surroundings). Returns notes of what was done, one sentence each. A scene
/// that gets a camera must have its aggregate. Throws Error: Scene when there is nothing to frame,
/// Usage as find_camera.
std::vector<std::string> complete_view(SceneDescription& description, Scene& scene,
                                       const FramingOptions& options);

}  // namespace alhazen
