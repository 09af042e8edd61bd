// Outlines as an SVG with a layer for each solid.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/imaging/image/encoding.h"
#include "alhazen/solids/section.h"

namespace alhazen {

namespace {

constexpr std::array<const char*, 5> kLengthUnits{"mm", "cm", "in", "pt", "px"};

/// Text for XML: markup is escaped; control characters and non-ASCII characters become '?'.
std::string xml(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c >= ' ' && c < '\x7f' ? c : '?';
        }
    }
    return out;
}

std::string css(const Rgb& color) {
    std::string out = "#";
    for (int i = 0; i < 3; ++i) {
        out += fmt::format("{:02x}", encode_channel(color[i], Encoding::Srgb, 8));
    }
    return out;
}

/// The corners of the visible region, y downward: all loops; without loops the projection of
/// `around` onto the plane, or a unit square.
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

/// SVG coordinates have y downward.
std::string path_of(const SectionOutlines& outlines) {
    std::string d;
    for (const Polyline& loop : outlines.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            d += fmt::format("{}{:.10g} {:.10g}", i == 0 ? "M" : "L", loop[i].x, 0.0 - loop[i].y);
        }
        d += "Z";
    }
    return d;
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
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"{:.10g}{}\" "
        "height=\"{:.10g}{}\" viewBox=\"{:.10g} {:.10g} {:.10g} {:.10g}\">\n",
        size.x, options.unit, size.y, options.unit, lo.x - margin, lo.y - margin, size.x, size.y);
    out += fmt::format(
        "<desc>Section by the plane ({:.17g}, {:.17g}, {:.17g}) . p = {:.17g}. Right is ({:.17g}, "
        "{:.17g}, {:.17g}), up is ({:.17g}, {:.17g}, {:.17g}); y counts downward. One user unit is "
        "one unit of the scene. Within {:.6g} of the curves.</desc>\n",
        n.x, n.y, n.z, dot(n, frame.origin), frame.right.x, frame.right.y, frame.right.z,
        frame.up.x, frame.up.y, frame.up.z, options.tolerance);
    for (const SectionLayer& layer : layers) {
        const auto id = static_cast<std::uint64_t>(layer.solid);
        out += fmt::format(
            "<g id=\"solid-{}\" inkscape:groupmode=\"layer\" inkscape:label=\"{}\">\n"
            "<title>{}</title>\n<path fill=\"{}\" fill-rule=\"evenodd\" fill-opacity=\"0.6\" "
            "stroke=\"#101010\" stroke-width=\"1\" vector-effect=\"non-scaling-stroke\" "
            "d=\"{}\"/>\n</g>\n",
            id, xml(layer.name), xml(layer.name), css(layer.color), path_of(layer.outlines));
    }
    return out + "</svg>\n";
}

}  // namespace alhazen
