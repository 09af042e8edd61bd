#include "alhazen/laboratory/report/compare_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "alhazen/imaging/figures/heat_map.h"
#include "alhazen/laboratory/html_text.h"
#include "alhazen/laboratory/report/compare_charts.h"
#include "alhazen/laboratory/report/compare_page_assets.h"
#include "alhazen/session/statistics.h"

namespace alhazen {
namespace {

/// Colour scale of the cost per pixel, shared by all accelerators of a scene.
struct CostScale {
    double low = 0, high = 1;  ///< log10

    explicit CostScale(const Comparison& c) {
        double least = 1e300, most = 0;
        for (const Measurement& m : c.measurements) {
            for (const float cost : m.cost) {
                if (!(cost > 0)) continue;
                least = std::min(least, double{cost});
                most = std::max(most, double{cost});
            }
        }
        if (most <= 0) return;
        low = std::log10(least);
        high = std::max(std::log10(most), low + 0.1);
    }
    [[nodiscard]] double place(double cost) const {
        return cost > 0 ? (std::log10(cost) - low) / (high - low) : 0;
    }
};

std::uint16_t code(double x) {
    return static_cast<std::uint16_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
}

/// Draws pixels that were not rendered in grey.
EncodedImage heat_image(const Comparison& c, const Measurement& m, const CostScale& scale) {
    EncodedImage image{c.width, c.height};
    image.samples.reserve(3 * m.cost.size());
    for (const float cost : m.cost) {
        const Rgb color =
            std::isnan(cost) ? Rgb{0.5, 0.5, 0.5} : heat_color(scale.place(double{cost}));
        for (int k = 0; k < 3; ++k) image.samples.push_back(code(color[k]));
    }
    return image;
}

std::string gradient() {
    std::string stops;
    constexpr int kStops = 16;
    for (int i = 0; i <= kStops; ++i) {
        const Rgb c = heat_color(static_cast<double>(i) / kStops);
        stops +=
            fmt::format("{}#{:02x}{:02x}{:02x}", i > 0 ? "," : "", code(c.r), code(c.g), code(c.b));
    }
    return "linear-gradient(90deg," + stops + ")";
}

std::string variant_text(const Measurement& m) {
    return m.variant == Measurement::Variant::Tuned ? " (tuned)" : "";
}

std::string viewer(const Comparison& c) {
    const CostScale scale(c);
    const EncodedImage picture = encode(c.picture.data(), c.width, c.height, c.encoding, 8);
    std::string thumbs, first, first_name;
    for (const Measurement& m : c.measurements) {
        if (!m.unavailable.empty()) continue;
        const std::string name = html_escaped(m.accelerator + variant_text(m));
        const std::string uri = png_data_uri(heat_image(c, m, scale));
        if (first.empty()) {
            first = uri;
            first_name = name;
        }
        thumbs += fmt::format(
            "<button type=\"button\" aria-pressed=\"{}\" data-name=\"{}\"><img alt=\"Cost of each "
            "pixel "
            "with {}\" width=\"{}\" height=\"{}\" src=\"{}\">{}{}</button>\n",
            thumbs.empty() ? "true" : "false", name, name, c.width, c.height, uri, html_name(m),
            m.picture.complete ? "" : " <small>sample</small>");
    }
    return fmt::format(
        "<div class=\"card viewer\"><div><div class=\"stage\"><img alt=\"The picture\" "
        "width=\"{0}\" "
        "height=\"{1}\" src=\"{2}\"><img alt=\"Cost of each pixel with {3}\" width=\"{0}\" "
        "height=\"{1}\" src=\"{4}\"><i></i></div>"
        "<input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"How much of the "
        "picture "
        "is shown, the rest is the cost\"><div class=\"ends\"><span>&#9664; the picture</span>"
        "<span>cost of <b class=\"shown\">{3}</b> &#9654;</span></div>"
        "<div class=\"scale\" style=\"background:{5}\"></div><div class=\"ends\"><span>{6}</span>"
        "<span>nodes and cells visited, bounds and primitives tested for each pixel (logarithmic, "
        "one scale for all)</span>"
        "<span>{7}</span></div></div><div class=\"thumbs\">{8}</div></div>\n",
        c.width, c.height, png_data_uri(picture), first_name, first, gradient(),
        short_number(std::pow(10, scale.low)), short_number(std::pow(10, scale.high)), thumbs);
}

std::string cell(double x, const char* after = "") {
    return fmt::format("<td data-value=\"{:.9g}\">{}{}</td>", x, short_number(x), after);
}

std::string agreement_cell(const Measurement& m) {
    if (!m.agrees()) return "<td class=\"no\">differs</td>";
    const bool all = m.figures.all_counted && m.picture.complete;
    return fmt::format("<td class=\"yes\">{}</td>", all ? "same" : "same (sample)");
}

std::string table_row(const Comparison& c, const Measurement& m) {
    if (!m.unavailable.empty()) {
        return fmt::format("<tr><th scope=\"row\">{}</th><td colspan=\"13\">{}</td></tr>\n",
                           html_name(m), html_escaped(m.unavailable));
    }
    const ReplayFigures& f = m.figures;
    const auto ratio = [&](const char* name) {
        const Measurement* reference = c.find(name);
        return reference == nullptr || reference->figures.nanoseconds() == 0
                   ? std::string("<td data-value=\"0\"></td>")
                   : cell(f.nanoseconds() / reference->figures.nanoseconds());
    };
    std::string row = fmt::format("<tr><th scope=\"row\">{}</th>", html_name(m));
    row += cell(f.nanoseconds(), f.all_timed ? "" : " *") + ratio("list") + ratio("wide_bvh");
    for (const auto count :
         {&TraversalStats::primitive_tests, &TraversalStats::box_tests, &TraversalStats::slab_tests,
          &TraversalStats::node_visits, &TraversalStats::empty_cells,
          &TraversalStats::mailbox_saved, &TraversalStats::heap_pushes}) {
        row += cell(f.each(count));
    }
    return row + cell(1e3 * m.build_seconds) + cell(static_cast<double>(m.bytes) / 1024) +
           agreement_cell(m) + "</tr>\n";
}

std::string table(const Comparison& c) {
    constexpr const char* kHeads[] = {
        "accelerator", "ns",        "&times; list", "&times; wide_bvh", "primitives",
        "bounds",      "slabs",     "nodes, cells", "empty cells",      "mailbox saves",
        "heap pushes", "build, ms", "KiB",          "picture and rays"};
    std::string text =
        "<div class=\"card scroll\" tabindex=\"0\" role=\"region\" aria-label=\"All "
        "figures\"><table>"
        "<caption>Means for each ray, all kinds together. A click on a heading sorts. * of a "
        "sample of "
        "the rays.</caption><thead><tr>";
    for (const char* head : kHeads) {
        text += fmt::format("<th scope=\"col\"><button type=\"button\">{}</button></th>", head);
    }
    text += "</tr></thead><tbody>\n";
    for (const Measurement& m : c.measurements) text += table_row(c, m);
    return text + "</tbody></table></div>\n";
}

std::string facts(const Comparison& c) {
    std::string rays;
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (c.rays.rays[k].cast == 0) continue;
        rays +=
            fmt::format("{}{} {}", rays.empty() ? "" : ", ", c.rays.rays[k].cast, kRayKindNames[k]);
    }
    return fmt::format(
        "<p class=\"facts\">{} &times; {} pixels &middot; {} primitives &middot; rays: {}</p>",
        c.width, c.height, c.census.effective_primitives, rays);
}

std::string badge(const Comparison& c) {
    std::size_t built = 0, differing = 0;
    for (const Measurement& m : c.measurements) {
        built += m.unavailable.empty();
        differing += m.unavailable.empty() && !m.agrees();
    }
    if (differing == 0) {
        return fmt::format(
            "<p><span class=\"badge good\">&#10003; the same, bit for bit</span> {} lines: what "
            "rays hit, "
            "the pixels and the numbers of rays.</p>\n",
            built);
    }
    return fmt::format(
        "<p><span class=\"badge bad\">&#10007; {} of {} differ</span> from wide_bvh in what rays "
        "hit, in "
        "pixels or in numbers of rays.</p>\n",
        differing, built);
}

constexpr const char* kPolicy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

}  // namespace

std::string comparison_page(std::span<const Comparison> comparisons) {
    std::string title = "Accelerators side by side";
    for (const Comparison& c : comparisons) title += ", " + c.scene;
    std::string text = fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
        "<link rel=\"icon\" "
        "href=\"data:,\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n"
        "<header><div><h1>Accelerators side by side</h1><p class=\"soft\">Every accelerator is "
        "asked the "
        "same rays: how much work is it, and is the answer the same?</p></div>"
        "<button type=\"button\" id=\"theme\" hidden>light / dark</button></header>\n<main>\n",
        kPolicy, html_escaped(title), kComparePageStyle);
    for (const Comparison& c : comparisons) {
        text += fmt::format("<section><h2>{}</h2>\n", html_escaped(c.scene));
        text += facts(c) + badge(c) + viewer(c) + comparison_charts(c) + table(c) + "</section>\n";
    }
    text += fmt::format(
        "</main>\n<footer><p>alhazen {}. Times are processor time on one thread, of the rays "
        "alone. "
        "What takes too long is measured on a sample of the rays, spread evenly by chance, and of "
        "the "
        "picture; pixels that were not rendered are grey. Costs of pixels are counted one ray at a "
        "time, "
        "the other figures in the batches that the renderer "
        "asks.</p></footer>\n<script>{}</script>\n"
        "</body>\n</html>\n",
        version(), kComparePageScript);
    return text;
}

}  // namespace alhazen
