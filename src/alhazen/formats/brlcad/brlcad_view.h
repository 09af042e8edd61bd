#pragma once
/// Cameras as BRL-CAD's `rt` has them: from angles around the model, and from view scripts.
///
/// Source: BRL-CAD, manual page of `rt`: the options -a, -e, -p, and the commands of its scripts
/// (viewsize, eye_pt, orientation, viewrot, lookat_pt, ae, start, end). Differs: animation of the
/// model is not read. Conventions: a view has the eye at the origin, x to the right, y up, z
/// towards the viewer; it is `size` mm wide. Parallel rays start in the plane of the eye. Rays go
/// through the lower left corners of the pixels (ShadingConventions::PixelSample).

#include <optional>
#include <string>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/geometry/box.h"
#include "alhazen/math/affine.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Unit vectors of a view in the model.
struct BrlcadFrame {
    Vec3 right{0, 1, 0}, up{0, 0, 1}, to_eye{1, 0, 0};
};

/// The eye at this azimuth (from +x towards +y) and elevation, in degrees.
[[nodiscard]] BrlcadFrame brlcad_frame(double azimuth_deg, double elevation_deg);

/// The views that BRL-CAD has names for, of a model in `box`: the first from azimuth 35, elevation
/// 25, as `rt` without options; as wide as the box's diagonal. None for a box without volume.
[[nodiscard]] std::vector<CameraDescription> brlcad_cameras(const Box3& box,
                                                            const FileLocation& where);

/// A camera for each frame of a script; text in front of a shell's "<<EOF" is passed over. `file`
/// is its name for messages; `box` fits a view without size or eye.
[[nodiscard]] std::vector<CameraDescription> read_brlcad_views(std::string_view text,
                                                               const std::string& file,
                                                               const Box3& box,
                                                               Diagnostics& diagnostics);

}  // namespace alhazen
