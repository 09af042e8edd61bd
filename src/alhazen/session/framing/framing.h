#pragma once
/// Adds a camera that shows the whole scene, and a light, where a file has none.
///
/// Derivation: the nearest eye whose view pyramid holds a set of points: each side of the pyramid
/// gives one linear bound on the eye's position. The set grows by the farthest points of the scene
/// (seen_parts.h) beyond the sides of the pyramid found so far, until there are none.
/// Conventions: azimuth 0 sees the front. With Z up the front looks along +X and the azimuth turns
/// towards +Y; with Y up the front looks along +Z and the azimuth turns towards +X. The elevation
/// rises to the pole, 90 degrees. Boxes of any size that is a normal number.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/scene/scene.h"

namespace alhazen {

/// Direction of the eye as seen from the middle of the scene.
struct ViewAngles {
    double azimuth_deg = 30, elevation_deg = 20;
};

/// "30,20". Elevation in [-90, 90]. Throws Error (Usage).
[[nodiscard]] ViewAngles parse_view(const std::string& text);

/// From the front for a box that is flat towards the front; else from above and one side.
[[nodiscard]] ViewAngles default_view(const Box3& box, UpAxis up_axis);

/// The point of a scene with the largest dot(direction, point), if that is larger than `least`.
using FarthestPoint = std::function<std::optional<Vec3>(const Vec3& direction, double least)>;

/// A vertical field of view of 45 degrees; the scene fills all but 5 % of the picture on each side,
/// of its height or its width, and is centred. `box` holds the scene; bounded and not empty.
[[nodiscard]] PerspectiveCamera framing_camera(const Box3& box, UpAxis up_axis,
                                               const ViewAngles& view, double aspect,
                                               const FarthestPoint& farthest);
/// The same for the corners of the box.
[[nodiscard]] PerspectiveCamera framing_camera(const Box3& box, UpAxis up_axis,
                                               const ViewAngles& view, double aspect);

struct FramingOptions {
    std::optional<ViewAngles> view;  ///< if given: a framing camera is put before those of the file
    std::string camera;              ///< the selected camera; empty: the first
    double aspect = 4.0 / 3.0;       ///< width / height of the picture
    bool follows_light = false;      ///< of the renderer: environment and background light it
    bool nothing_around = false;     ///< neither lights nor surroundings are added
};

/// Whether a material of the scene emits light.
[[nodiscard]] bool glows(const Scene& scene);

/// True where `complete_view` adds a light, unless an environment or emitting materials are enough.
[[nodiscard]] bool lacks_light(const SceneDescription& description, const Scene& scene);

/// Adds a camera and a light to both, where they have none, and a grey background where a light was
/// added and the file has none. Formats whose scenes are meant as they are get no light
/// (ImportConventions::headlight). Where light is followed a background is one: a point at the eye
/// would be found behind water by those alone that send light from it. A scene with lights of its
/// own and without a background gets dim grey surroundings where its format has none
/// (ImportConventions::surroundings). Returns what was done, a sentence each. A scene that gets a
/// camera must have its aggregate. Throws Error: Scene when there is nothing to frame, Usage as
/// find_camera.
std::vector<std::string> complete_view(SceneDescription& description, Scene& scene,
                                       const FramingOptions& options);

}  // namespace alhazen
