#pragma once
/// A vector drawing: regions of constant or linearly changing colour, and lines.
///
/// Conventions: coordinates are in pixels of the picture, y points down. Colours are display values
/// (encoded), 0 to 1. Regions do not overlap; they are filled by the odd-even rule. Lines are drawn
/// over all regions, in order.

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// A colour gradient that is linear from one point to the other and constant across.
struct DrawingGradient {
    Vec2 from, to;
    Rgb at_from, at_to;
};

struct DrawingRegion {
    std::vector<std::vector<Vec2>> loops;
    Rgb color;
    std::optional<DrawingGradient> gradient;  ///< if set, replaces `color`
};

/// The regions of one object.
struct DrawingGroup {
    std::string title;
    std::vector<DrawingRegion> regions;
};

enum class LineStyle {
    Hidden,      ///< thin, dashed: an edge that is occluded
    Crease,      ///< thin: an edge where two faces meet
    Silhouette,  ///< thick: the outline of an object
};

/// Part of an ellipse: center + cos(t) u + sin(t) v, where u and v are conjugate half diameters.
struct DrawingArc {
    Vec2 center, u, v;
    double from = 0, to = 0;  ///< |to - from| is at most 2 pi

    [[nodiscard]] Vec2 at(double t) const { return center + std::cos(t) * u + std::sin(t) * v; }
};

struct DrawingLine {
    LineStyle style = LineStyle::Crease;
    std::vector<Vec2> points;
    bool closed = false;
    std::optional<DrawingArc> arc;  ///< if set, replaces `points`
};

struct Drawing {
    double width = 0, height = 0;
    Rgb background{1, 1, 1};
    std::vector<DrawingGroup> groups;
    std::vector<DrawingLine> lines;
    std::vector<std::string> notes;  ///< for the user: defects that were repaired
};

/// The drawing as SVG 1.1. Edges of regions are not antialiased, so that abutting regions leave no
/// gap.
[[nodiscard]] std::string drawing_svg(const Drawing& drawing);

/// The drawing as PDF 1.5 of one page, one point per pixel. Throws Error (Resource) if Cairo fails.
[[nodiscard]] std::string drawing_pdf(const Drawing& drawing);

}  // namespace alhazen
