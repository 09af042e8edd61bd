#pragma once
/// Chooses the build quality of a tree by the work that it saves in a picture.
///
/// Model: `fast` builds a triangle in less time, and then each ray takes longer. The rays of a
/// picture are estimated: one eye ray a sample, and a shadow ray to each light. The limit is
/// measured (docs/log/whole_pictures.md#build-quality-by-the-picture).

#include <cstddef>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"

namespace alhazen {

/// Rays for each triangle from which on BuildQuality::Default is chosen.
inline constexpr double kRaysOfDefaultBuild = 32.0;

/// Fast if the rays are few for the triangles, else Default.
[[nodiscard]] BuildQuality quality_for(std::size_t triangles, double rays);

/// The quality for a picture of a loaded scene, whose aggregate may be missing. Throws Error
/// (Usage) for an unknown camera and a size out of range.
[[nodiscard]] BuildQuality quality_for_picture(const LoadedScene& loaded,
                                               const RenderOptions& options);

}  // namespace alhazen
