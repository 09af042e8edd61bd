#pragma once
/// Draws an accelerator's traversal for one ray as SVG: the visited cells, numbered in order, and
/// the tested bounds and primitives.
/// Conventions: parallel projection along an axis of the world, or isometric. Light and dark mode
/// follow the reader's setting. Text sizes are for a picture 900 units wide.

#include <string>

#include "alhazen/laboratory/traversal_trace.h"

namespace alhazen {

enum class FigureView { AlongX, AlongY, AlongZ, Isometric };

/// Parses "x", "y", "z" or "isometric". Throws Error (Usage).
[[nodiscard]] FigureView parse_figure_view(const std::string& name);
/// The view along the axis on which the ray extends least.
[[nodiscard]] FigureView natural_view(const Ray& ray);

[[nodiscard]] std::string traversal_svg(const Scene& scene, const TraversalTrace& trace,
                                        FigureView view);

}  // namespace alhazen
