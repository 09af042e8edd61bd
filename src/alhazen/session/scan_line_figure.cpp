#include "alhazen/session/scan_line_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "alhazen/imaging/svg/svg_writer.h"

namespace alhazen {

namespace {

constexpr double kLeft = 60, kTop = 90, kWidth = 220, kHeight = 420, kGap = 40, kBars = 80;
constexpr double kSeconds = 12;
constexpr std::size_t kMostSteps = 240;  ///< of the animation

struct TableCurve {
    const char* name;
    const char* color;
    std::uint32_t ScanLineTables::*size;
};
constexpr std::array<TableCurve, 3> kTables{
    {{"patches in buckets", "#2b6cb0", &ScanLineTables::waiting},
     {"active patches", "#c05621", &ScanLineTables::active},
     {"polygons", "#2f855a", &ScanLineTables::polygons}}};

std::uint32_t most_of(const ScanLineReport& report, const TableCurve& table) {
    std::uint32_t most = 1;
    for (const ScanLineTables& line : report.lines) most = std::max(most, line.*table.size);
    return most;
}

double row_at(const ScanLineReport& report, std::size_t line) {
    return kTop + kHeight * (static_cast<double>(line) + 0.5) /
                      static_cast<double>(std::max<std::size_t>(1, report.lines.size()));
}

/// "a;b;c": the values of an animation.
template <class Value>
std::string key_values(const ScanLineReport& report, Value&& value) {
    const std::size_t steps = std::min(kMostSteps, report.lines.size());
    std::string text;
    for (std::size_t k = 0; k < steps; ++k) {
        const std::size_t line = k * report.lines.size() / steps;
        text += (text.empty() ? "" : ";") + svg::decimals(value(line), 1);
    }
    return text;
}

void animate(svg::Writer& out, const char* attribute, const std::string& values) {
    out.leaf("animate", {{"attributeName", attribute},
                         {"dur", svg::decimals(kSeconds, 0) + "s"},
                         {"repeatCount", "indefinite"},
                         {"values", values}});
}

void draw_curve(svg::Writer& out, const ScanLineReport& report, const TableCurve& table,
                double left) {
    const double most = most_of(report, table);
    out.leaf("rect", {{"x", svg::decimals(left, 0)},
                      {"y", svg::decimals(kTop, 0)},
                      {"width", svg::decimals(kWidth, 0)},
                      {"height", svg::decimals(kHeight, 0)},
                      {"fill", "#f7f7f4"}});
    std::vector<Vec2> corners{{left, kTop}};
    for (std::size_t k = 0; k < report.lines.size(); ++k) {
        corners.push_back(
            {left + kWidth * (report.lines[k].*table.size) / most, row_at(report, k)});
    }
    corners.push_back({left, kTop + kHeight});
    out.leaf("polygon", {{"points", svg::points(corners)},
                         {"fill", table.color},
                         {"fill-opacity", "0.35"},
                         {"stroke", table.color}});
    out.text(
        "text",
        {{"x", svg::decimals(left, 0)}, {"y", svg::decimals(kTop - 10, 0)}, {"fill", table.color}},
        fmt::format("{}: at most {}", table.name, most_of(report, table)));
}

/// A bar whose length is that of the table at the moving scan line.
void draw_bar(svg::Writer& out, const ScanLineReport& report, const TableCurve& table, double left,
              double top) {
    const double most = most_of(report, table);
    out.open("rect", {{"x", svg::decimals(left, 0)},
                      {"y", svg::decimals(top, 0)},
                      {"width", "0"},
                      {"height", "16"},
                      {"fill", table.color}});
    animate(out, "width", key_values(report, [&](std::size_t line) {
                return kWidth * (report.lines[line].*table.size) / most;
            }));
    out.close();
}

}  // namespace

std::string scan_line_svg(const ScanLineReport& report, const std::string& title) {
    const double width = kLeft + 3 * kWidth + 3 * kGap, height = kTop + kHeight + kBars;
    svg::Writer out;
    out.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                     {"viewBox", fmt::format("0 0 {:.0f} {:.0f}", width, height)},
                     {"font-family", "sans-serif"},
                     {"font-size", "14"}});
    out.leaf("rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "white"}});
    out.text("text", {{"x", svg::decimals(kLeft, 0)}, {"y", "30"}, {"font-size", "18"}}, title);
    out.text("text", {{"x", svg::decimals(kLeft, 0)}, {"y", "52"}, {"fill", "#555"}},
             fmt::format("{} patches, split {} times in u and {} in v into {} polygons; most in "
                         "memory: {} patches, {} polygons",
                         report.patches, report.split_u, report.split_v, report.quads,
                         report.most_patches, report.most_polygons));
    for (std::size_t k = 0; k <= 4; ++k) {
        const std::size_t line = k * report.lines.size() / 4;
        out.text("text",
                 {{"x", svg::decimals(kLeft - 8, 0)},
                  {"y", svg::decimals(kTop + kHeight * static_cast<double>(k) / 4 + 5, 0)},
                  {"text-anchor", "end"},
                  {"fill", "#555"}},
                 fmt::format("{}", line));
    }
    for (std::size_t k = 0; k < kTables.size(); ++k) {
        const double left = kLeft + static_cast<double>(k) * (kWidth + kGap);
        draw_curve(out, report, kTables[k], left);
        draw_bar(out, report, kTables[k], left, kTop + kHeight + 24);
    }
    out.open("line", {{"x1", svg::decimals(kLeft, 0)},
                      {"x2", svg::decimals(width - kGap, 0)},
                      {"y1", svg::decimals(kTop, 0)},
                      {"y2", svg::decimals(kTop, 0)},
                      {"stroke", "#222"}});
    const std::string rows =
        key_values(report, [&](std::size_t line) { return row_at(report, line); });
    animate(out, "y1", rows);
    animate(out, "y2", rows);
    out.close();
    return out.finish();
}

}  // namespace alhazen
