// Outlines as an SVG with one layer per solid.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/imaging/svg/svg_writer.h"
#include "alhazen/solids/section.h"

namespace alhazen {

namespace {

constexpr std::array<const char*, 5> kLengthUnits{"mm", "cm", "in", "pt", "px"};

/// The bounds of the SVG, y downward: those of all loops; without loops, of the projection of
/// `around` onto the plane, or a square of one unit.
void find_corners(const std::vector<SectionLayer>& layers, const PlaneFrame& frame,
                  const Box3& around, Vec2& lo, Vec2& hi) {
    const double inf = std::numeric_limits<double>::infinity();
    lo = {inf, inf};
    hi = {-inf, -inf};
    for (const SectionLayer& layer : layers) {
        for (const Polyline& loop : layer.outlines.loops) {
            for (const Vec2& p : loop) {
                lo = {std::min(lo.x, p.x), std::min(lo.y, -p.y)};
                hi = {std::max(hi.x, p.x), std::max(hi.y, -p.y)};
            }
        }
    }
    if (lo.x <= hi.x) return;
    lo = {-0.5, -0.5};
    hi = {0.5, 0.5};
    if (around.empty() || !around.bounded()) return;
    const double level_x = dot(frame.right, frame.origin), level_y = dot(frame.up, frame.origin);
    const Interval x = extent(around, frame.right), y = extent(around, frame.up);
    lo = {x.lo - level_x, level_y - y.hi};
    hi = {x.hi - level_x, level_y - y.lo};
}

/// The path of the outlines, with y downward.
std::string path_of(const SectionOutlines& outlines) {
    svg::Path path;
    for (const Polyline& loop : outlines.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec2 p{loop[i].x, 0.0 - loop[i].y};
            i == 0 ? path.move_to(p) : path.line_to(p);
        }
        path.close();
    }
    return path.data();
}

}  // namespace

std::string section_svg(const std::vector<SectionLayer>& layers, const PlaneFrame& frame,
                        const SvgOptions& options) {
    if (std::find(kLengthUnits.begin(), kLengthUnits.end(), options.unit) == kLengthUnits.end()) {
        throw Error(ErrorKind::Usage,
                    "unknown unit '" + options.unit + "': expected mm, cm, in, pt or px");
    }
    Vec2 lo, hi;
    find_corners(layers, frame, options.around, lo, hi);
    const double margin = std::max(0.02 * std::max(hi.x - lo.x, hi.y - lo.y), 1e-9);
    const Vec2 size{hi.x - lo.x + 2 * margin, hi.y - lo.y + 2 * margin};
    const Vec3& n = frame.normal;
    svg::Writer out;
    out.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                     {"xmlns:inkscape", "http://www.inkscape.org/namespaces/inkscape"},
                     {"width", svg::digits(size.x) + options.unit},
                     {"height", svg::digits(size.y) + options.unit},
                     {"viewBox", fmt::format("{:.10g} {:.10g} {:.10g} {:.10g}", lo.x - margin,
                                             lo.y - margin, size.x, size.y)}});
    out.text("desc", {},
             fmt::format("Section by the plane ({:.17g}, {:.17g}, {:.17g}) . p = {:.17g}. Right is "
                         "({:.17g}, {:.17g}, {:.17g}), up is ({:.17g}, {:.17g}, {:.17g}); y counts "
                         "downward. One user unit is one unit of the scene. Within {:.6g} of the "
                         "curves.",
                         n.x, n.y, n.z, dot(n, frame.origin), frame.right.x, frame.right.y,
                         frame.right.z, frame.up.x, frame.up.y, frame.up.z, options.tolerance));
    for (const SectionLayer& layer : layers) {
        out.open("g", {{"id", fmt::format("solid-{}", static_cast<std::uint64_t>(layer.solid))},
                       {"inkscape:groupmode", "layer"},
                       {"inkscape:label", layer.name}});
        out.text("title", {}, layer.name);
        out.leaf("path", {{"fill", css_color(layer.color)},
                          {"fill-rule", "evenodd"},
                          {"fill-opacity", "0.6"},
                          {"stroke", "#101010"},
                          {"stroke-width", "1"},
                          {"vector-effect", "non-scaling-stroke"},
                          {"d", path_of(layer.outlines)}});
        out.close();
    }
    return out.finish();
}

}  // namespace alhazen
