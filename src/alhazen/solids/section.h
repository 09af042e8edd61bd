#pragma once
/// A scene cut by a plane: a picture of the remaining part, and the outlines of the cut.
///
/// Conventions: the side of the normal is removed. Without a camera the view is parallel, against
/// the normal, z up (or y, for a level plane). Cut faces show the colour of their solid, unshaded,
/// with dark edges; surfaces behind are shaded by a light at the eye. Where solids overlap, the
/// lowest number shows.

#include <optional>
#include <string>
#include <vector>

#include "alhazen/imaging/image/image.h"
#include "alhazen/solids/section_outlines.h"
#include "alhazen/solids/solid_scene.h"

namespace alhazen {

struct SectionView {
    int width = 800, height = 800;
    int grid = 3;                  ///< grid x grid samples per pixel
    std::optional<Camera> camera;  ///< none: parallel, against the normal
};

[[nodiscard]] Image section_picture(const SolidScene& solids, const Scene& scene,
                                    const SectionPlane& plane, const SectionView& view);

/// The outlines of one solid and its colour.
struct SectionLayer {
    SolidId solid{};
    std::string name;
    Rgb color;  ///< linear
    SectionOutlines outlines;
};

/// Display colour of a material: its albedo, or its transmissive or reflective colour.
[[nodiscard]] Rgb color_of(const Scene& scene, MaterialId material);

struct SvgOptions {
    std::string unit = "mm";  ///< unit of the scene: mm, cm, in, pt, px
    double tolerance = 1e-4;
    /// Box whose projection onto the plane is shown if nothing is cut.
    Box3 around{};
};

/// An SVG with one layer per solid, in units of the scene. Throws Error (Usage) for an unknown
/// unit.
[[nodiscard]] std::string section_svg(const std::vector<SectionLayer>& layers,
                                      const PlaneFrame& frame, const SvgOptions& options);

}  // namespace alhazen
