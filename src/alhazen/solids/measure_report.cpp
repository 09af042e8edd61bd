#include "alhazen/solids/measure_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "alhazen/base/control_characters.h"
#include "alhazen/solids/vector_json.h"

namespace alhazen {

namespace {

using json = nlohmann::ordered_json;

json estimate_json(const Estimate& e) {
    return {{"value", e.value}, {"interval", {e.lo(), e.hi()}}};
}

Estimate scaled(double factor, const Estimate& e) {
    const double size = std::abs(factor);
    return {factor * e.value, size * e.half_width, size * e.rounding};
}

/// The sum of independent estimates. Their rounding errors are not independent: they add up.
Estimate sum(const Estimate& a, const Estimate& b) {
    const double rounding = a.rounding + b.rounding;
    const double scatter = std::hypot(a.half_width - a.rounding, b.half_width - b.rounding);
    return {a.value + b.value, scatter + rounding, rounding};
}

json densities_json(const std::vector<std::optional<double>>& densities) {
    json out = json::array();
    for (const std::optional<double>& one : densities) out.push_back(one ? json(*one) : json());
    return out;
}

json solid_json(const SolidReport& r) {
    const SolidMeasures& m = r.measures;
    json out{{"solid", static_cast<std::uint64_t>(r.solid)}, {"name", r.name}};
    out["box"] = m.box.empty() ? json(nullptr) : json{vector_json(m.box.lo), vector_json(m.box.hi)};
    out["volume"] = estimate_json(m.volume);
    out["area"] = estimate_json(m.area);
    out["area_by_crofton"] = estimate_json(m.area_by_crofton);
    json centroid = json::array(), inertia = json::array(), directions = json::array();
    for (const Estimate& e : m.centroid) centroid.push_back(estimate_json(e));
    for (const Estimate& e : m.inertia)
        inertia.push_back(estimate_json(scaled(r.density().value_or(1), e)));
    for (std::size_t k = 0; k < 3; ++k) {
        directions.push_back({{"direction", vector_json(m.directions[k])},
                              {"volume", estimate_json(m.volume_by_direction[k])}});
    }
    out["centroid"] = m.has_moments ? std::move(centroid) : json(nullptr);
    if (r.density()) {
        out["density"] = *r.density();
        out["mass"] = estimate_json(scaled(*r.density(), m.volume));
    } else if (r.densities.size() > 1) {
        out["densities"] = densities_json(r.densities);
        out["mass"] = nullptr;
    }
    out["inertia_density"] = r.density().value_or(1);
    out["inertia_xx_yy_zz_xy_yz_zx"] = m.has_moments ? std::move(inertia) : json(nullptr);
    if (r.section) {
        out["section_area"] = estimate_json(r.section->area);
    }
    out["directions"] = std::move(directions);
    out["directions_agree"] = m.directions_agree;
    out["areas_agree"] = m.areas_agree;
    out["lines"] = m.lines;
    out["inconsistent_lines"] = m.inconsistent_lines;
    out["in_range"] = m.in_range;
    out["reached"] = m.reached;
    out["seconds"] = r.seconds;
    return out;
}

json pair_json(const PairReport& r) {
    json out{{"a", static_cast<std::uint64_t>(r.a)},
             {"name_a", r.name_a},
             {"b", static_cast<std::uint64_t>(r.b)},
             {"name_b", r.name_b}};
    if (r.overlap) {
        out["overlap_volume"] = estimate_json(r.overlap->volume);
        out["reached"] = r.overlap->reached;
    }
    if (r.clearance) {
        const Clearance& c = *r.clearance;
        out["clearance"] = {{"overlap", c.overlap},        {"at_least", c.at_least},
                            {"at_most", c.at_most},        {"on_a", vector_json(c.on_a)},
                            {"on_b", vector_json(c.on_b)}, {"error", c.error}};
    }
    return out;
}

/// The value with digits down to the interval, then the interval.
std::string text_of(const Estimate& e) {
    if (!(e.half_width > 0)) return fmt::format("{:.15g}", e.value);
    const double exponent = std::floor(std::log10(e.half_width)) - 1;
    const int decimals = static_cast<int>(std::clamp(-exponent, 0.0, 17.0));
    // Intervals too narrow and values too large for fixed notation are written with an exponent.
    if (e.half_width < 1e-15 || std::abs(e.value) >= 1e15) {
        return fmt::format("{:.16g} +- {:.2g}", e.value, e.half_width);
    }
    return fmt::format("{:.{}f} +- {:.2g}", e.value, decimals, e.half_width);
}

std::string inertia_text(const SolidMeasures& m, std::optional<double> density) {
    constexpr std::array<const char*, 6> kNames{"xx", "yy", "zz", "xy", "yz", "zx"};
    std::string out;
    for (std::size_t k = 0; k < kNames.size(); ++k) {
        out += fmt::format("  {:<10}{} {}\n", k == 0 ? "inertia" : "", kNames[k],
                           text_of(scaled(density.value_or(1), m.inertia[k])));
    }
    if (!density) out += fmt::format("  {:<10}(density 1)\n", "");
    return out;
}

std::string densities_text(const std::vector<std::optional<double>>& densities) {
    std::string out;
    for (const std::optional<double>& one : densities) {
        if (!out.empty()) out += ", ";
        out += one ? fmt::format("{:.9g}", *one) : "none";
    }
    return out;
}

std::string solid_text(const SolidReport& r) {
    const SolidMeasures& m = r.measures;
    std::string out =
        fmt::format("{} {}\n", static_cast<std::uint64_t>(r.solid), escape_controls(r.name));
    const auto line = [&](const char* what, const std::string& value) {
        out += fmt::format("  {:<10}{}\n", what, value);
    };
    line("box", m.box.empty() ? "none: the solid is empty"
                              : fmt::format("({:.9g}, {:.9g}, {:.9g}) to ({:.9g}, {:.9g}, {:.9g})",
                                            m.box.lo.x, m.box.lo.y, m.box.lo.z, m.box.hi.x,
                                            m.box.hi.y, m.box.hi.z));
    line("volume", text_of(m.volume));
    line("area", text_of(m.area));
    line("", text_of(m.area_by_crofton) + " by Crofton's count");
    if (m.has_moments) {
        line("centroid", text_of(m.centroid[0]));
        line("", text_of(m.centroid[1]));
        line("", text_of(m.centroid[2]));
    } else {
        line("centroid", "none: nothing was met");
    }
    if (r.density()) {
        line("density", fmt::format("{:.9g}", *r.density()));
        line("mass", text_of(scaled(*r.density(), m.volume)));
    } else if (r.densities.size() > 1) {
        line("mass", "none: its materials differ in density (" + densities_text(r.densities) + ")");
    }
    if (m.has_moments) out += inertia_text(m, r.density());
    if (r.section) line("section", text_of(r.section->area));
    line("lines", fmt::format("{} in {:.2f} s{}", m.lines, r.seconds,
                              m.reached ? "" : "; the wanted error was not reached"));
    if (m.inconsistent_lines > 0) {
        line("WARNING",
             fmt::format("the crossings of {} line{} did not come in pairs: is it closed?",
                         m.inconsistent_lines, m.inconsistent_lines == 1 ? "" : "s"));
    }
    if (m.volume.value == 0 && m.volume.half_width > m.volume.rounding) {
        line("WARNING",
             "no line met the solid: the intervals bound what all of them may have missed");
    }
    if (!m.in_range) {
        line("WARNING",
             "numbers overflow or vanish: the solid is too large or too small; scale it");
    }
    if (!m.directions_agree) {
        line("WARNING", "the volumes along three directions differ beyond chance: is it closed?");
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& d = m.directions[k];
            line("", fmt::format("along ({:.3f}, {:.3f}, {:.3f}) {}", d.x, d.y, d.z,
                                 text_of(m.volume_by_direction[k])));
        }
    }
    if (!m.areas_agree) line("WARNING", "the two areas differ beyond chance");
    return out;
}

std::string pair_text(const PairReport& r) {
    std::string out =
        fmt::format("{} {} and {} {}\n", static_cast<std::uint64_t>(r.a), escape_controls(r.name_a),
                    static_cast<std::uint64_t>(r.b), escape_controls(r.name_b));
    if (r.overlap) {
        out += fmt::format("  overlap   {}{}\n", text_of(r.overlap->volume),
                           r.overlap->reached ? ""
                           : r.overlap->volume.value == 0
                               ? " (met by no line: what all may have missed)"
                               : " (the wanted error was not reached)");
    }
    if (r.clearance) {
        const Clearance& c = *r.clearance;
        if (c.overlap) {
            out += fmt::format("  clearance none: both hold ({:.9g}, {:.9g}, {:.9g})\n", c.on_a.x,
                               c.on_a.y, c.on_a.z);
        } else {
            out += fmt::format(
                "  clearance from {:.12g} (slab between the two) to {:.12g} (distance of\n"
                "            ({:.9g}, {:.9g}, {:.9g}) and ({:.9g}, {:.9g}, {:.9g}))\n",
                c.at_least, c.at_most, c.on_a.x, c.on_a.y, c.on_a.z, c.on_b.x, c.on_b.y, c.on_b.z);
        }
    }
    return out;
}

/// Volume and mass of all solids together; overlaps count once for each solid.
struct Totals {
    Estimate volume, area, mass;
    std::size_t with_mass = 0;  ///< how many solids have one
};
Totals totals_of(const std::vector<SolidReport>& solids) {
    Totals all;
    for (const SolidReport& r : solids) {
        all.volume = sum(all.volume, r.measures.volume);
        all.area = sum(all.area, r.measures.area);
        if (!r.density()) continue;
        all.mass = sum(all.mass, scaled(*r.density(), r.measures.volume));
        ++all.with_mass;
    }
    return all;
}

}  // namespace

bool SolidReport::holds() const {
    return measures.directions_agree && measures.areas_agree && measures.in_range &&
           measures.inconsistent_lines == 0;
}

bool MeasureReport::holds() const {
    return std::all_of(solids.begin(), solids.end(),
                       [](const SolidReport& r) { return r.holds(); });
}

json measure_json(const MeasureReport& report) {
    json solids = json::array(), pairs = json::array();
    for (const SolidReport& r : report.solids) solids.push_back(solid_json(r));
    for (const PairReport& r : report.pairs) pairs.push_back(pair_json(r));
    json out{{"confidence", 0.95}, {"open_surfaces", report.open_surfaces}};
    out["open_meshes"] = report.open_meshes;
    out["solids"] = std::move(solids);
    if (report.solids.size() > 1) {
        const Totals all = totals_of(report.solids);
        out["total"] = {{"volume", estimate_json(all.volume)}, {"area", estimate_json(all.area)}};
        if (all.with_mass == report.solids.size()) {
            out["total"]["mass"] = estimate_json(all.mass);
        } else if (all.with_mass > 0) {
            out["total"]["mass"] = nullptr;
        }
    }
    if (!report.pairs.empty()) out["pairs"] = std::move(pairs);
    out["holds"] = report.holds();
    return out;
}

std::string measure_text(const MeasureReport& report) {
    std::string out;
    for (const SolidReport& r : report.solids) out += solid_text(r);
    if (report.solids.size() > 1) {
        const Totals all = totals_of(report.solids);
        out += fmt::format("all {} solids\n  volume    {}\n  area      {}\n", report.solids.size(),
                           text_of(all.volume), text_of(all.area));
        if (all.with_mass == report.solids.size()) {
            out += fmt::format("  mass      {}\n", text_of(all.mass));
        } else if (all.with_mass > 0) {
            out += fmt::format("  mass      none: {} of the solids have no mass\n",
                               report.solids.size() - all.with_mass);
        }
    }
    for (const PairReport& r : report.pairs) out += pair_text(r);
    if (report.open_surfaces > 0) {
        out +=
            report.open_surfaces == 1
                ? "left out: 1 surface that bounds no volume\n"
                : fmt::format("left out: {} surfaces that bound no volume\n", report.open_surfaces);
        for (const std::string& open : report.open_meshes) out += "  " + open + "\n";
    }
    return out;
}

}  // namespace alhazen
