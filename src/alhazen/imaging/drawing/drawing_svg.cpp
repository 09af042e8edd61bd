#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "alhazen/imaging/drawing/drawing_style.h"
#include "alhazen/imaging/svg/svg_writer.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

std::string encoded_color(const Rgb& c) {
    std::string out = "#";
    for (int i = 0; i < 3; ++i) {
        out += fmt::format("{:02x}", std::lround(255.0 * std::clamp(c[i], 0.0, 1.0)));
    }
    return out;
}

/// Appends a number with three decimals, without trailing zeros.
void append_number(std::string& out, double x) {
    std::string text = fmt::format("{:.3f}", x);
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    out += text == "-0" ? "0" : text;
}

void append_path(std::string& out, const std::vector<Vec2>& points, bool closed) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        out += i == 0 ? 'M' : 'L';
        append_number(out, points[i].x);
        out += ' ';
        append_number(out, points[i].y);
    }
    if (closed) out += 'Z';
}

/// Appends an arc by the principal half axes of the ellipse, as two arcs, neither longer than a
/// half.
void append_arc(std::string& out, const DrawingArc& arc) {
    const Vec2 &u = arc.u, &v = arc.v;
    const double t = 0.5 * std::atan2(2.0 * (u.x * v.x + u.y * v.y),
                                      u.x * u.x + u.y * u.y - v.x * v.x - v.y * v.y);
    const Vec2 long_axis = arc.at(t) - arc.center, short_axis = arc.at(t + kPi / 2) - arc.center;
    const bool clockwise = (u.x * v.y - u.y * v.x) * (arc.to - arc.from) > 0.0;
    const auto number = [&](double x) {
        append_number(out, x);
        out += ' ';
    };
    const auto point = [&](double at) {
        number(arc.at(at).x);
        append_number(out, arc.at(at).y);
    };
    out += 'M';
    point(arc.from);
    for (const double end : {0.5 * (arc.from + arc.to), arc.to}) {
        out += 'A';
        number(std::hypot(long_axis.x, long_axis.y));
        number(std::hypot(short_axis.x, short_axis.y));
        number(std::atan2(long_axis.y, long_axis.x) * 180.0 / kPi);
        out += clockwise ? "0 1 " : "0 0 ";
        point(end);
    }
}

std::string path_of(const DrawingRegion& region) {
    std::string path;
    for (const std::vector<Vec2>& loop : region.loops) append_path(path, loop, true);
    return path;
}

void write_gradient(svg::Writer& out, const DrawingGradient& g, const std::string& id) {
    const auto number = [](double x) {
        std::string text;
        append_number(text, x);
        return text;
    };
    out.open("linearGradient", {{"id", id},
                                {"gradientUnits", "userSpaceOnUse"},
                                {"x1", number(g.from.x)},
                                {"y1", number(g.from.y)},
                                {"x2", number(g.to.x)},
                                {"y2", number(g.to.y)}});
    out.leaf("stop", {{"offset", "0"}, {"stop-color", encoded_color(g.at_from)}});
    out.leaf("stop", {{"offset", "1"}, {"stop-color", encoded_color(g.at_to)}});
    out.close();
}

}  // namespace

std::string drawing_svg(const Drawing& drawing) {
    svg::Writer out;
    const std::string width = svg::digits(drawing.width), height = svg::digits(drawing.height);
    out.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                     {"width", width},
                     {"height", height},
                     {"viewBox", "0 0 " + width + " " + height}});
    std::string rules =
        ".f{stroke:none;fill-rule:evenodd;shape-rendering:crispEdges}"
        "path{fill:none;stroke:#000;stroke-linejoin:round;stroke-linecap:round}";
    for (const LineLook& look : kLineLooks) {
        rules += fmt::format(".{}{{stroke-width:{}", look.name, look.width);
        if (look.dash[0] > 0)
            rules += fmt::format(";stroke-dasharray:{} {}", look.dash[0], look.dash[1]);
        rules += '}';
    }
    out.text("style", {}, rules);
    out.open("defs");
    std::size_t gradients = 0;
    for (const DrawingGroup& group : drawing.groups) {
        for (const DrawingRegion& region : group.regions) {
            if (region.gradient) {
                write_gradient(out, *region.gradient, "g" + std::to_string(gradients++));
            }
        }
    }
    out.close();
    out.leaf("rect",
             {{"width", width}, {"height", height}, {"fill", encoded_color(drawing.background)}});
    std::size_t next = 0;
    for (const DrawingGroup& group : drawing.groups) {
        out.open("g");
        if (!group.title.empty()) out.text("title", {}, group.title);
        for (const DrawingRegion& region : group.regions) {
            const std::string fill = region.gradient ? "url(#g" + std::to_string(next++) + ")"
                                                     : encoded_color(region.color);
            // `fill` as a style attribute: the style sheet sets one for all paths.
            out.leaf("path", {{"class", "f"}, {"style", "fill:" + fill}, {"d", path_of(region)}});
        }
        out.close();
    }
    for (const DrawingLine& line : drawing.lines) {
        std::string path;
        if (line.arc) {
            append_arc(path, *line.arc);
        } else {
            append_path(path, line.points, line.closed);
        }
        out.leaf("path", {{"class", look_of(line.style).name}, {"d", path}});
    }
    return out.finish();
}

}  // namespace alhazen
