#pragma once
/// A scene cut open by a plane: the picture of what is left, and the outlines of the cut.
///
/// Conventions: what lies on the side of the normal is taken away. Without a camera the picture
/// looks against the normal, from far away, z (or y, for a level plane) up. Cut faces show the
/// colour of their solid, flat, with dark edges; what is seen behind is shaded by a light at the
/// eye. Where solids overlap, the one with the lowest number shows.

#include <optional>
#include <string>
#include <vector>

#include "alhazen/imaging/image/image.h"
#include "alhazen/solids/section_outlines.h"
#include "alhazen/solids/solid_scene.h"

namespace alhazen {

struct SectionView {
    int width = 800, height = 800;
    int grid = 3;                  ///< grid x grid samples in a pixel
    std::optional<Camera> camera;  ///< none: straight on
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

/// The colour of what a material is made of: its albedo, or what it lets through or mirrors.
[[nodiscard]] Rgb color_of(const Scene& scene, MaterialId material);

struct SvgOptions {
    std::string unit = "mm";  ///< what a unit of the scene is: mm, cm, in, pt, px
    double tolerance = 1e-4;
    /// What is shown when nothing is cut: where this box stands in the plane.
    Box3 around{};
};

/// An SVG with a layer for each solid, in units of the scene. Throws Error (Usage) for another
/// unit.
[[nodiscard]] std::string section_svg(const std::vector<SectionLayer>& layers,
                                      const PlaneFrame& frame, const SvgOptions& options);

}  // namespace alhazen
