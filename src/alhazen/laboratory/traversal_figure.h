#pragma once
/// A drawing of what an accelerator does for one ray, as SVG: the cells it visits, numbered in
/// their order, the bounds and the primitives it tests.
///
/// Conventions: a parallel projection: along an axis of the world, or isometric. Light and dark
/// follow the reader's choice. Text sizes are those of a picture 900 units wide.

#include <string>

#include "alhazen/laboratory/traversal_trace.h"

namespace alhazen {

enum class FigureView { AlongX, AlongY, AlongZ, Isometric };

/// "x", "y", "z" or "isometric". Throws Error (Usage).
[[nodiscard]] FigureView parse_figure_view(const std::string& name);
/// Along the axis along which the ray goes least.
[[nodiscard]] FigureView natural_view(const Ray& ray);

[[nodiscard]] std::string traversal_svg(const Scene& scene, const TraversalTrace& trace,
                                        FigureView view);

}  // namespace alhazen
