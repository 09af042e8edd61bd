#pragma once
/// Cameras of BRL-CAD's `rt`: from angles around the model, and from view scripts.
///
/// Source: BRL-CAD, manual page of `rt`: the options -a, -e, -p, and the commands of its scripts
/// (viewsize, eye_pt, orientation, viewrot, lookat_pt, ae, start, end).
/// Differs: animation of the model is not supported.
/// Conventions: a view has the eye at the origin, x to the right, y up, z towards the viewer; it is
/// `size` mm wide. Parallel rays start in the plane of the eye. Rays pass through the lower left
/// corners of the pixels (SamplingConventions::PixelSample).

#include <optional>
#include <string>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/geometry/box.h"
#include "alhazen/math/affine.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Unit vectors of a view in model space.
struct BrlcadFrame {
    Vec3 right{0, 1, 0}, up{0, 0, 1}, to_eye{1, 0, 0};
};

/// The view from this azimuth (from +x towards +y) and elevation, in degrees.
[[nodiscard]] BrlcadFrame brlcad_frame(double azimuth_deg, double elevation_deg);

/// The named views of BRL-CAD for a model in `box`, each as wide as the diagonal of the box. The
/// first has azimuth 35 and elevation 25, the default of `rt`. Empty for a box without volume.
[[nodiscard]] std::vector<CameraDescription> brlcad_cameras(const Box3& box,
                                                            const FileLocation& where);

/// Reads one camera per frame of a script; skips the text before a shell's "<<EOF". `file`: name
/// for messages; `box`: used to fit views without size or eye.
[[nodiscard]] std::vector<CameraDescription> read_brlcad_views(std::string_view text,
                                                               const std::string& file,
                                                               const Box3& box,
                                                               Diagnostics& diagnostics);

/// The background colour that the shell command of a saved view passes to `rt` (-C red/green/blue).
[[nodiscard]] std::optional<Rgb> brlcad_view_background(std::string_view text);

}  // namespace alhazen
