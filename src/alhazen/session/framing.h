#pragma once
/// Adds a camera that shows the whole scene, and a light, where a file has none.
///
/// Derivation: the nearest eye whose view pyramid contains the eight corners of a box: each side of
/// the pyramid gives one linear bound on the eye's position.
/// Conventions: azimuth 0 shows the front. With Z up the front looks along +X and the azimuth turns
/// towards +Y; with Y up the front looks along +Z and the azimuth turns towards +X. The elevation
/// rises to the pole, 90 degrees. Boxes of any normal (not subnormal) size.

#include <optional>
#include <string>
#include <vector>

#include "alhazen/scene/scene.h"

namespace alhazen {

/// Direction from the centre of the scene to the eye.
struct ViewAngles {
    double azimuth_deg = 30, elevation_deg = 20;
};

/// "30,20". Elevation in [-90, 90]. Throws Error (Usage).
[[nodiscard]] ViewAngles parse_view(const std::string& text);

/// The box of all bounded primitives.
[[nodiscard]] Box3 bounded_part(const Aggregate& aggregate);

/// From the front for a box that is flat towards the front; otherwise from above and one side.
[[nodiscard]] ViewAngles default_view(const Box3& box, UpAxis up_axis);

/// A vertical field of view of 45 degrees; the box fills the image up to margins of 5 % on each
/// side. `box` must be bounded and not empty.
[[nodiscard]] PerspectiveCamera framing_camera(const Box3& box, UpAxis up_axis,
                                               const ViewAngles& view, double aspect);

struct FramingOptions {
    std::optional<ViewAngles> view;  ///< if given: adds a framing camera before those of the file
    std::string camera;              ///< the selected camera; empty: the first
    double aspect = 4.0 / 3.0;       ///< width / height of the image
};

/// Adds a camera and a light to both, where they have none, and a grey background where a light was
/// added and the file has none. Formats whose scenes are complete by definition get no light
/// (ImportConventions::headlight). Returns one sentence per change. A scene that gets a camera must
/// have its aggregate. Throws Error: Scene when there is nothing to frame, Usage as find_camera.
std::vector<std::string> complete_view(SceneDescription& description, Scene& scene,
                                       const FramingOptions& options);

}  // namespace alhazen
