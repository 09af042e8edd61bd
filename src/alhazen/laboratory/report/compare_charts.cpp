#include "alhazen/laboratory/report/compare_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "alhazen/laboratory/html_text.h"

namespace alhazen {
namespace {

constexpr const char* kKindTitles[] = {"eye", "shadow", "reflected", "refracted"};

/// Logarithmic scale over positive numbers, bounded by ticks on both sides.
class LogScale {
  public:
    void include(double x) {
        if (!(x > 0) || !std::isfinite(x)) return;
        least_ = std::min(least_, x);
        most_ = std::max(most_, x);
    }
    [[nodiscard]] bool empty() const { return least_ > most_; }
    /// Ticks at 1, 2 and 5 times powers of ten; at powers of ten only if there would be too many.
    void make_ticks() {
        const bool fine = most_ < 300 * least_;
        for (double decade = std::pow(10, std::floor(std::log10(least_))); ticks_.size() < 99;
             decade *= 10) {
            for (const double step : {1.0, 2.0, 5.0}) {
                if (!fine && step > 1) continue;
                const double tick = step * decade;
                if (tick <= least_) ticks_.clear();  // keeps only the last tick below the data
                ticks_.push_back(tick);
                if (tick >= most_ && ticks_.size() > 1) return;
            }
        }
    }
    [[nodiscard]] const std::vector<double>& ticks() const { return ticks_; }
    /// Position on the scale, in percent.
    [[nodiscard]] double place(double x) const {
        if (!(x > 0)) return 0;
        return 100.0 * std::log(x / ticks_.front()) / std::log(ticks_.back() / ticks_.front());
    }

  private:
    double least_ = std::numeric_limits<double>::infinity(), most_ = 0;
    std::vector<double> ticks_;
};

const char* variant_class(Measurement::Variant variant) {
    switch (variant) {
        case Measurement::Variant::Default:
            return "plain";
        case Measurement::Variant::Tuned:
            return "tuned";
        case Measurement::Variant::Given:
            break;
    }
    return "given";
}

using Row = const Measurement*;

std::vector<Row> sorted_rows(const Comparison& c,
                             const std::function<double(const Measurement&)>& key) {
    std::vector<Row> rows;
    for (const Measurement& m : c.measurements) {
        if (m.unavailable.empty()) rows.push_back(&m);
    }
    std::stable_sort(rows.begin(), rows.end(), [&](Row a, Row b) { return key(*a) < key(*b); });
    return rows;
}

/// Vertical grid lines, drawn as backgrounds of the tracks.
std::string grid_of(const LogScale& scale) {
    std::string grid;
    for (const double tick : scale.ticks()) {
        grid +=
            fmt::format("{}linear-gradient(var(--line),var(--line)) {:.2f}% 0/1px 100% no-repeat",
                        grid.empty() ? "" : ",", scale.place(tick));
    }
    return grid;
}

std::string axis_of(const LogScale& scale) {
    std::string axis = "<dt></dt><dd class=\"axis\"><span class=\"track\">";
    double last = -100;
    for (const double tick : scale.ticks()) {
        const double place = scale.place(tick);
        // The first label is right of its line, the others are centred on theirs.
        if (place - last < (last == 0 ? 20 : 14)) continue;
        last = place;
        axis += fmt::format("<span style=\"left:{:.2f}%\">{}</span>", place, short_number(tick));
    }
    return axis + "</span><span class=\"value\"></span></dd>";
}

std::string card(const std::string& title, const std::string& what, const LogScale& scale,
                 const std::string& key, const std::string& rows) {
    return fmt::format(
        "<div class=\"card\"><h3>{}</h3><p class=\"soft\">{}</p>{}<dl class=\"chart\" "
        "style=\"--grid:{}\">{}{}</dl></div>\n",
        title, what, key, grid_of(scale), rows, axis_of(scale));
}

std::string variant_key(const Comparison& c) {
    bool tuned = false, given = false;
    for (const Measurement& m : c.measurements) {
        tuned = tuned || m.variant == Measurement::Variant::Tuned;
        given = given || m.variant == Measurement::Variant::Given;
    }
    if (!tuned && !given) return "";
    std::string key = "<p class=\"key\"><span><span class=\"swatch\"></span>defaults</span>";
    if (tuned) key += "<span><span class=\"swatch tuned\"></span>best settings found</span>";
    if (given) key += "<span><span class=\"swatch given\"></span>settings given</span>";
    return key + "</p>";
}

std::string bars(const Comparison& c, const std::string& title, const std::string& what,
                 const std::string& unit, const std::function<double(const Measurement&)>& value) {
    LogScale scale;
    const std::vector<Row> rows = sorted_rows(c, value);
    for (const Row m : rows) scale.include(value(*m));
    if (scale.empty()) return "";
    scale.make_ticks();
    std::string text;
    for (const Row m : rows) {
        const double x = value(*m);
        text += fmt::format(
            "<dt>{}</dt><dd class=\"{}\"><span class=\"track\"><span class=\"fill\" "
            "style=\"width:{:.2f}%\"></span></span>"
            "<span class=\"value\">{} {}</span></dd>",
            html_name(*m), variant_class(m->variant), scale.place(x), short_number(x), unit);
    }
    return card(title, what, scale, variant_key(c), text);
}

std::string kind_key(const Comparison& c) {
    std::string key = "<p class=\"key\">";
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (c.recorded[k] == 0) continue;
        key += fmt::format("<span><span class=\"dot {}\"></span>{} rays</span>", kRayKindNames[k],
                           kKindTitles[k]);
    }
    return key + "</p>";
}

/// One dot per kind of ray.
std::string dots(const Comparison& c, const std::string& title, const std::string& what,
                 const std::function<double(const Measurement&, const KindFigures&)>& value,
                 const std::function<double(const Measurement&)>& mean) {
    LogScale scale;
    const std::vector<Row> rows = sorted_rows(c, mean);
    for (const Row m : rows) {
        for (const KindFigures& kind : m->figures.kinds) scale.include(value(*m, kind));
    }
    if (scale.empty()) return "";
    scale.make_ticks();
    std::string text;
    for (const Row m : rows) {
        text += fmt::format("<dt>{}</dt><dd class=\"lanes {}\"><span class=\"track\">",
                            html_name(*m), variant_class(m->variant));
        for (std::size_t k = 0; k < kRayKindCount; ++k) {
            const double x = value(*m, m->figures.kinds[k]);
            if (c.recorded[k] == 0 || !(x > 0)) continue;
            text += fmt::format(
                "<span class=\"dot {}\" style=\"left:{:.2f}%\" title=\"{}: {}\"></span>",
                kRayKindNames[k], scale.place(x), kKindTitles[k], short_number(x));
        }
        text += fmt::format("</span><span class=\"value\">{}</span></dd>", short_number(mean(*m)));
    }
    return card(title, what, scale, kind_key(c), text);
}

}  // namespace

std::string short_number(double x) {
    if (x == 0) return "0";
    const double size = std::abs(x);
    if (size >= 9.995e9) return fmt::format("{:.3g} G", x * 1e-9);
    if (size >= 9.995e6) return fmt::format("{:.3g} M", x * 1e-6);
    if (size >= 9.995e3) return fmt::format("{:.3g} k", x * 1e-3);
    if (size >= 99.95) return fmt::format("{:.0f}", x);
    return fmt::format("{:.3g}", x);
}

std::string html_name(const Measurement& m) {
    const std::string name = html_escaped(m.name());
    if (m.settings().empty()) return name;
    return fmt::format("{}<small>{}{}</small>", name, html_escaped(m.settings()),
                       m.variant == Measurement::Variant::Tuned ? " (tuned)" : "");
}

std::string comparison_charts(const Comparison& c) {
    const auto nanoseconds = [](const Measurement& m) { return m.figures.nanoseconds(); };
    const auto tests = [](const Measurement& m) {
        return m.figures.each(&TraversalStats::primitive_tests);
    };
    const auto steps = [](const Measurement& m) {
        return m.figures.each(&TraversalStats::box_tests) +
               m.figures.each(&TraversalStats::node_visits);
    };
    std::string text = "<div class=\"charts\">\n";
    text += bars(c, "Time for each ray", "Processor time on one thread, without shading.", "ns",
                 nanoseconds);
    text += dots(
        c, "Primitives tested for each ray", "The number is the mean of all rays.",
        [](const Measurement&, const KindFigures& k) { return k.each(k.tests.primitive_tests); },
        tests);
    text += dots(
        c, "Nodes, cells and bounds for each ray", "Nodes and cells visited and bounds tested.",
        [](const Measurement&, const KindFigures& k) {
            return k.each(k.tests.box_tests + k.tests.node_visits);
        },
        steps);
    text += dots(
        c, "Time for each ray by kind", "Nanoseconds; the number is the mean of all rays.",
        [](const Measurement&, const KindFigures& k) { return k.nanoseconds(); }, nanoseconds);
    text += bars(c, "Time to build", "Processor time on one thread, with the scene's own tables.",
                 "ms", [](const Measurement& m) { return 1e3 * m.build_seconds; });
    text += bars(c, "Memory", "Of the structures, without the primitives.", "KiB",
                 [](const Measurement& m) { return static_cast<double>(m.bytes) / 1024; });
    return text + "</div>\n";
}

}  // namespace alhazen
