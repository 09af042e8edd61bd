#pragma once
/// A picture without pixels: regions of flat or evenly changing colour, and lines.
///
/// Conventions: coordinates are in pixels of the picture, y points down. Colours are as a display
/// takes them (encoded), 0 to 1. Regions do not overlap; they are filled by the odd-even rule.
/// Lines are drawn over all regions, in order.

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// Colours change linearly from one point to the other, and not across.
struct DrawingGradient {
    Vec2 from, to;
    Rgb at_from, at_to;
};

struct DrawingRegion {
    std::vector<std::vector<Vec2>> loops;
    Rgb color;
    std::optional<DrawingGradient> gradient;  ///< instead of `color`
};

/// Regions that belong to one thing.
struct DrawingGroup {
    std::string title;
    std::vector<DrawingRegion> regions;
};

enum class LineStyle {
    Hidden,      ///< thin, dashed: an edge behind something
    Crease,      ///< thin: two faces meet
    Silhouette,  ///< thick: an object ends
};

/// Part of an ellipse: center + cos(t) u + sin(t) v; u and v are conjugate half diameters.
struct DrawingArc {
    Vec2 center, u, v;
    double from = 0, to = 0;  ///< to - from: at most 2 pi in either direction

    [[nodiscard]] Vec2 at(double t) const { return center + std::cos(t) * u + std::sin(t) * v; }
};

struct DrawingLine {
    LineStyle style = LineStyle::Crease;
    std::vector<Vec2> points;
    bool closed = false;
    std::optional<DrawingArc> arc;  ///< instead of `points`
};

struct Drawing {
    double width = 0, height = 0;
    Rgb background{1, 1, 1};
    std::vector<DrawingGroup> groups;
    std::vector<DrawingLine> lines;
    std::vector<std::string> notes;  ///< for the user: what was mended on the way
};

/// As SVG 1.1. Regions are drawn without smoothing of their edges, so that abutting ones leave no
/// gap.
[[nodiscard]] std::string drawing_svg(const Drawing& drawing);

/// As PDF 1.5 of one page, a point for each pixel. Throws Error (Resource) where Cairo fails.
[[nodiscard]] std::string drawing_pdf(const Drawing& drawing);

}  // namespace alhazen
