#include "alhazen/session/scan_line_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "alhazen/imaging/svg/svg_writer.h"

namespace alhazen {

namespace {

constexpr double kTablesLeft = 60, kTablesTop = 90, kTablesWidth = 220, kTablesHeight = 420,
                 kTablesGap = 40, kTablesBars = 80;
constexpr double kTablesSeconds = 12;
constexpr std::size_t kTablesMostSteps = 240;  ///< steps of the animation

struct TableCurve {
    const char* name;
    const char* color;
    std::uint32_t ScanLineTables::*size;
};
constexpr std::array<TableCurve, 3> kScanTables{
    {{"patches in buckets", "#2b6cb0", &ScanLineTables::waiting},
     {"active patches", "#c05621", &ScanLineTables::active},
     {"polygons", "#2f855a", &ScanLineTables::polygons}}};

std::uint32_t most_of_table(const ScanLineReport& report, const TableCurve& table) {
    std::uint32_t most = 1;
    for (const ScanLineTables& line : report.lines) most = std::max(most, line.*table.size);
    return most;
}

double table_row_at(const ScanLineReport& report, std::size_t line) {
    return kTablesTop + kTablesHeight * (static_cast<double>(line) + 0.5) /
                            static_cast<double>(std::max<std::size_t>(1, report.lines.size()));
}

/// "a;b;c": the values of an animation.
template <class Value>
std::string table_key_values(const ScanLineReport& report, Value&& value) {
    const std::size_t steps = std::min(kTablesMostSteps, report.lines.size());
    std::string text;
    for (std::size_t k = 0; k < steps; ++k) {
        const std::size_t line = k * report.lines.size() / steps;
        text += (text.empty() ? "" : ";") + svg::decimals(value(line), 1);
    }
    return text;
}

void animate_tables(svg::Writer& out, const char* attribute, const std::string& values) {
    out.leaf("animate", {{"attributeName", attribute},
                         {"dur", svg::decimals(kTablesSeconds, 0) + "s"},
                         {"repeatCount", "indefinite"},
                         {"values", values}});
}

void draw_table_curve(svg::Writer& out, const ScanLineReport& report, const TableCurve& table,
                      double left) {
    const double most = most_of_table(report, table);
    out.leaf("rect", {{"x", svg::decimals(left, 0)},
                      {"y", svg::decimals(kTablesTop, 0)},
                      {"width", svg::decimals(kTablesWidth, 0)},
                      {"height", svg::decimals(kTablesHeight, 0)},
                      {"fill", "#f7f7f4"}});
    std::vector<Vec2> corners{{left, kTablesTop}};
    for (std::size_t k = 0; k < report.lines.size(); ++k) {
        corners.push_back(
            {left + kTablesWidth * (report.lines[k].*table.size) / most, table_row_at(report, k)});
    }
    corners.push_back({left, kTablesTop + kTablesHeight});
    out.leaf("polygon", {{"points", svg::points(corners)},
                         {"fill", table.color},
                         {"fill-opacity", "0.35"},
                         {"stroke", table.color}});
    out.text("text",
             {{"x", svg::decimals(left, 0)},
              {"y", svg::decimals(kTablesTop - 10, 0)},
              {"fill", table.color}},
             fmt::format("{}: at most {}", table.name, most_of_table(report, table)));
}

/// A bar whose length is that of the table at the moving scan line.
void draw_table_bar(svg::Writer& out, const ScanLineReport& report, const TableCurve& table,
                    double left, double top) {
    const double most = most_of_table(report, table);
    out.open("rect", {{"x", svg::decimals(left, 0)},
                      {"y", svg::decimals(top, 0)},
                      {"width", "0"},
                      {"height", "16"},
                      {"fill", table.color}});
    animate_tables(out, "width", table_key_values(report, [&](std::size_t line) {
                       return kTablesWidth * (report.lines[line].*table.size) / most;
                   }));
    out.close();
}

}  // namespace

std::string scan_line_svg(const ScanLineReport& report, const std::string& title) {
    const double width = kTablesLeft + 3 * kTablesWidth + 3 * kTablesGap,
                 height = kTablesTop + kTablesHeight + kTablesBars;
    svg::Writer out;
    out.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                     {"viewBox", fmt::format("0 0 {:.0f} {:.0f}", width, height)},
                     {"font-family", "sans-serif"},
                     {"font-size", "14"}});
    out.leaf("rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "white"}});
    out.text("text", {{"x", svg::decimals(kTablesLeft, 0)}, {"y", "30"}, {"font-size", "18"}},
             title);
    out.text("text", {{"x", svg::decimals(kTablesLeft, 0)}, {"y", "52"}, {"fill", "#555"}},
             fmt::format("{} patches, split {} times in u and {} in v into {} polygons; most in "
                         "memory: {} patches, {} polygons",
                         report.patches, report.split_u, report.split_v, report.quads,
                         report.most_patches, report.most_polygons));
    for (std::size_t k = 0; k <= 4; ++k) {
        const std::size_t line = k * report.lines.size() / 4;
        out.text(
            "text",
            {{"x", svg::decimals(kTablesLeft - 8, 0)},
             {"y", svg::decimals(kTablesTop + kTablesHeight * static_cast<double>(k) / 4 + 5, 0)},
             {"text-anchor", "end"},
             {"fill", "#555"}},
            fmt::format("{}", line));
    }
    for (std::size_t k = 0; k < kScanTables.size(); ++k) {
        const double left = kTablesLeft + static_cast<double>(k) * (kTablesWidth + kTablesGap);
        draw_table_curve(out, report, kScanTables[k], left);
        draw_table_bar(out, report, kScanTables[k], left, kTablesTop + kTablesHeight + 24);
    }
    out.open("line", {{"x1", svg::decimals(kTablesLeft, 0)},
                      {"x2", svg::decimals(width - kTablesGap, 0)},
                      {"y1", svg::decimals(kTablesTop, 0)},
                      {"y2", svg::decimals(kTablesTop, 0)},
                      {"stroke", "#222"}});
    const std::string rows =
        table_key_values(report, [&](std::size_t line) { return table_row_at(report, line); });
    animate_tables(out, "y1", rows);
    animate_tables(out, "y2", rows);
    out.close();
    return out.finish();
}

}  // namespace alhazen
