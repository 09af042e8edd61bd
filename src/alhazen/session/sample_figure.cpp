#include "alhazen/session/sample_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "alhazen/imaging/svg/svg_writer.h"
#include "alhazen/sampling/analysis/discrepancy.h"

namespace alhazen {

namespace {

constexpr double kPanel = 360, kPanelGap = 50, kPanelTop = 60, kPanelLeft = 40;
constexpr double kRadii = 2.5;       ///< relative to the root of the number of points
constexpr double kWhitePower = 3.0;  ///< relative to independent points
constexpr int kGreys = 24;

double panel_left(int panel) {
    return kPanelLeft + panel * (kPanel + kPanelGap);
}

/// The frequencies that the figure shows.
int reach_of(std::size_t points) {
    return std::max(4, static_cast<int>(std::ceil(kRadii * std::sqrt(points))));
}

void begin_panel(svg::Writer& out, int panel, const std::string& title, const char* fill) {
    out.text("text", {{"x", svg::decimals(panel_left(panel), 0)}, {"y", "45"}}, title);
    out.leaf("rect", {{"x", svg::decimals(panel_left(panel), 0)},
                      {"y", svg::decimals(kPanelTop, 0)},
                      {"width", svg::decimals(kPanel, 0)},
                      {"height", svg::decimals(kPanel, 0)},
                      {"fill", fill},
                      {"stroke", "#999"}});
}

void draw_points(svg::Writer& out, const SampleStudy& study) {
    begin_panel(out, 0, fmt::format("{} points", study.points.size()), "#fff");
    const double radius =
        std::clamp(kPanel * 0.12 / std::sqrt(static_cast<double>(study.points.size())), 1.0, 5.0);
    const std::size_t quarter =
        study.sampler->progressive ? study.points.size() / 4 : study.points.size();
    for (std::size_t k = 0; k < study.points.size(); ++k) {
        const Vec2& p = study.points[k];
        out.leaf("circle", {{"cx", svg::decimals(panel_left(0) + kPanel * p.x, 2)},
                            {"cy", svg::decimals(kPanelTop + kPanel * (1.0 - p.y), 2)},
                            {"r", svg::decimals(radius, 1)},
                            {"fill", k < quarter ? "#1a202c" : "#8aa6c8"}});
    }
}

/// Draws runs of equal greys as one rectangle.
void draw_periodogram(svg::Writer& out, const Periodogram& spectrum) {
    begin_panel(out, 1, "periodogram", "#000");
    const int reach = spectrum.reach(), side = 2 * reach + 1;
    const double cell = kPanel / side;
    const auto grey_at = [&](int fx, int fy) {
        const double level = std::sqrt(std::min(1.0, spectrum.power(fx, fy) / kWhitePower));
        return static_cast<int>(std::lround(level * kGreys));
    };
    for (int fy = -reach; fy <= reach; ++fy) {
        for (int begin = -reach; begin <= reach;) {
            const int grey = grey_at(begin, fy);
            int end = begin + 1;
            while (end <= reach && grey_at(end, fy) == grey) ++end;
            const int code = 255 * grey / kGreys;
            if (grey > 0) {
                out.leaf("rect", {{"x", svg::decimals(panel_left(1) + cell * (begin + reach), 2)},
                                  {"y", svg::decimals(kPanelTop + cell * (reach - fy), 2)},
                                  {"width", svg::decimals(cell * (end - begin), 2)},
                                  {"height", svg::decimals(cell, 2)},
                                  {"fill", fmt::format("#{0:02x}{0:02x}{0:02x}", code)}});
            }
            begin = end;
        }
    }
}

void draw_radial(svg::Writer& out, const std::vector<double>& mean, const char* color) {
    std::vector<Vec2> corners;
    for (std::size_t k = 0; k < mean.size(); ++k) {
        const double radius = (static_cast<double>(k) + 0.5) / kStudyBins;
        if (radius > kRadii) break;
        corners.push_back({panel_left(2) + kPanel * radius / kRadii,
                           kPanelTop + kPanel * (1.0 - std::min(1.0, mean[k] / kWhitePower))});
    }
    out.leaf("polyline", {{"points", svg::points(corners)},
                          {"fill", "none"},
                          {"stroke", color},
                          {"stroke-width", "2"}});
}

void draw_radial_means(svg::Writer& out, const SampleStudy& study) {
    begin_panel(out, 2, "radial mean of the power, by frequency / root(points)", "#fff");
    const double one = kPanelTop + kPanel * (1.0 - 1.0 / kWhitePower);
    out.leaf("line", {{"x1", svg::decimals(panel_left(2), 0)},
                      {"x2", svg::decimals(panel_left(2) + kPanel, 0)},
                      {"y1", svg::decimals(one, 1)},
                      {"y2", svg::decimals(one, 1)},
                      {"stroke", "#ccc"}});
    if (!study.radial_quarter.empty()) draw_radial(out, study.radial_quarter, "#c05621");
    draw_radial(out, study.radial, "#2b6cb0");
    for (int k = 0; k <= static_cast<int>(2 * kRadii); ++k) {
        out.text("text",
                 {{"x", svg::decimals(panel_left(2) + kPanel * 0.5 * k / kRadii, 1)},
                  {"y", svg::decimals(kPanelTop + kPanel + 18, 0)},
                  {"text-anchor", "middle"}},
                 svg::digits(0.5 * k));
    }
    for (int k = 0; k <= static_cast<int>(kWhitePower); ++k) {
        out.text("text",
                 {{"x", svg::decimals(panel_left(2) - 8, 0)},
                  {"y", svg::decimals(kPanelTop + kPanel * (1.0 - k / kWhitePower) + 4, 1)},
                  {"text-anchor", "end"}},
                 svg::digits(k));
    }
}

}  // namespace

SampleStudy study_sampler(const SamplerEntry& entry, const SampleStudyOptions& options) {
    const std::unique_ptr<Sampler> sampler = entry.make(options.seed, options.points);
    const std::size_t quarter = options.points / 4;
    SampleStudy study{&entry, options, {}, 0.0, 0.0, Periodogram(reach_of(options.points)), {}, {}};
    Periodogram of_quarter(reach_of(std::max<std::size_t>(1, quarter)));
    if (study.options.sets == 0) {
        study.options.sets = std::clamp(16384u / options.points, 4u, 256u);
    }
    const double share = 1.0 / study.options.sets;
    std::vector<Vec2> points(options.points);
    for (std::uint32_t k = 0; k < study.options.sets; ++k) {
        const auto step = static_cast<int>(k);
        const SamplePixel pixel{(options.pixel.x + step % 64) % SamplePixel::kMaxSide,
                                (options.pixel.y + step / 64) % SamplePixel::kMaxSide};
        sampler->points(pixel, options.pair, 0, points);
        if (k == 0) study.points = points;
        study.discrepancy += share * star_discrepancy(points);
        study.distance += share * smallest_distance(points) * std::sqrt(options.points);
        study.periodogram.add(points);
        if (entry.progressive && quarter > 0) of_quarter.add(std::span(points).first(quarter));
    }
    study.radial = study.periodogram.radial_mean(options.points, kStudyBins);
    if (entry.progressive && quarter > 0) {
        study.radial_quarter = of_quarter.radial_mean(quarter, kStudyBins);
    }
    return study;
}

std::string sample_figure(const SampleStudy& study) {
    svg::Writer out;
    const double width = panel_left(3), height = kPanelTop + kPanel + 40;
    out.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                     {"width", svg::decimals(width, 0)},
                     {"height", svg::decimals(height, 0)},
                     {"viewBox", fmt::format("0 0 {:.0f} {:.0f}", width, height)},
                     {"font-family", "sans-serif"},
                     {"font-size", "13"}});
    out.leaf("rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "#fff"}});
    out.text("text", {{"x", svg::decimals(kPanelLeft, 0)}, {"y", "22"}, {"font-size", "16"}},
             fmt::format("{}, dimensions {} and {}, seed {}; means of {} sets: star discrepancy "
                         "{:.4f}, nearest points {:.3f} / root({})",
                         study.sampler->name, 2 * study.options.pair, 2 * study.options.pair + 1,
                         study.options.seed, study.options.sets, study.discrepancy, study.distance,
                         study.points.size()));
    draw_points(out, study);
    draw_periodogram(out, study.periodogram);
    draw_radial_means(out, study);
    return out.finish();
}

}  // namespace alhazen
