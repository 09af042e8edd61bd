#include <fmt/format.h>

#include <cmath>

#include "alhazen/laboratory/report/compare_report.h"

namespace alhazen {
namespace {

constexpr int kNameWidth = 34;

/// Three significant digits in at most six characters.
std::string figure(double x) {
    if (x == 0) return "-";
    if (x >= 999999.5) {
        // 1.23e6: drop the sign and the leading zero of the exponent.
        const std::string text = fmt::format("{:.2e}", x);
        const std::size_t digits = text.find_first_not_of("+0", text.find('e') + 1);
        return text.substr(0, text.find('e') + 1) + text.substr(digits);
    }
    return x >= 99.95   ? fmt::format("{:.0f}", x)
           : x >= 9.995 ? fmt::format("{:.1f}", x)
                        : fmt::format("{:.2f}", x);
}

std::string name_of(const Measurement& m) {
    std::string name = m.accelerator;
    if (m.variant == Measurement::Variant::Tuned) name += " (tuned)";
    return name;
}

/// Puts a long name on its own line.
std::string named_line(const std::string& name) {
    if (name.size() <= kNameWidth) return fmt::format("{:<{}}", name, kNameWidth);
    return fmt::format("{}\n{:<{}}", name, "", kNameWidth);
}

std::string ratio(const Measurement* reference, const Measurement& m) {
    if (reference == nullptr || reference->figures.nanoseconds() == 0) return "-";
    return figure(m.figures.nanoseconds() / reference->figures.nanoseconds());
}

std::string verdict(const Measurement& m) {
    if (!m.agrees()) return "DIFFERS";
    return m.figures.all_counted && m.picture.complete ? "same" : "same*";
}

std::string line_of_all(const Comparison& c, const Measurement& m) {
    if (!m.unavailable.empty()) return named_line(name_of(m)) + " " + m.unavailable + "\n";
    const ReplayFigures& f = m.figures;
    const auto each = [&](std::uint64_t TraversalStats::*count) { return figure(f.each(count)); };
    return fmt::format(
        "{} {:>7.3f} {:>8} {:>7} {:>7} {:>7} {:>7} {:>6} {:>6} {:>7}{} {:>7} {:>7}  {}\n",
        named_line(name_of(m)), m.build_seconds,
        figure(static_cast<double>(m.bytes) / (1024.0 * 1024.0)),
        each(&TraversalStats::node_visits), each(&TraversalStats::box_tests),
        each(&TraversalStats::primitive_tests), each(&TraversalStats::mailbox_saved),
        each(&TraversalStats::heap_pushes), each(&TraversalStats::empty_cells),
        figure(f.nanoseconds()), f.all_timed ? ' ' : '*', ratio(c.find("list"), m),
        ratio(c.find("wide_bvh"), m), verdict(m));
}

std::string line_by_kind(const Comparison& c, const Measurement& m) {
    std::string line = named_line(name_of(m));
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (c.recorded[k] == 0) continue;
        const KindFigures& kind = m.figures.kinds[k];
        line +=
            fmt::format(" {:>7} {:>7} {:>7} {:>7}  ", figure(kind.each(kind.tests.node_visits)),
                        figure(kind.each(kind.tests.box_tests)),
                        figure(kind.each(kind.tests.primitive_tests)), figure(kind.nanoseconds()));
    }
    return line + "\n";
}

std::string header_by_kind(const Comparison& c) {
    std::string above = fmt::format("{:<{}}", "by kind of ray", kNameWidth);
    std::string below = fmt::format("{:<{}}", "", kNameWidth);
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (c.recorded[k] == 0) continue;
        above += fmt::format("{:>32}  ", kRayKindNames[k]);
        below += fmt::format("{:>8}{:>8}{:>8}{:>8}  ", "nodes", "boxes", "prims", "ns");
    }
    return above + "\n" + below + "\n";
}

std::string notes(const Comparison& c) {
    std::string text;
    bool sampled = false;
    for (const Measurement& m : c.measurements) {
        if (!m.unavailable.empty()) continue;
        sampled = sampled || !m.figures.all_timed || !m.figures.all_counted || !m.picture.complete;
        if (m.search_cut_short) text += fmt::format("{}: the search was cut short\n", name_of(m));
        if (m.agrees()) continue;
        text += fmt::format("{}: {} answers of rays differ, {} of {} pixels, the rays cast {}\n",
                            name_of(m), m.figures.disagreements, m.picture.differing,
                            m.picture.pixels, m.picture.same_rays ? "are the same" : "differ");
        if (!m.figures.first_disagreement.empty()) {
            text += "  " + m.figures.first_disagreement + "\n";
        }
    }
    if (sampled) text += "* of a sample of the rays or tiles, for all would take too long\n";
    return text;
}

}  // namespace

std::string comparison_table(const Comparison& c) {
    std::string text = fmt::format("{}: {}x{}, {} primitives", c.scene, c.width, c.height,
                                   c.census.effective_primitives);
    std::uint64_t all = 0;
    for (const RayCount& count : c.rays.rays) all += count.cast;
    text += fmt::format("; {} rays:", all);
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (c.rays.rays[k].cast > 0) {
            text += fmt::format(" {} {}", c.rays.rays[k].cast, kRayKindNames[k]);
        }
    }
    text += fmt::format("\n\n{:<{}}{:>8}{:>9}{:>8}{:>8}{:>8}{:>8}{:>7}{:>7}{:>8} {:>8}{:>8}\n",
                        "for each ray", kNameWidth, "build s", "MiB", "nodes", "boxes", "prims",
                        "saved", "heap", "empty", "ns", "/list", "/wide");
    for (const Measurement& m : c.measurements) text += line_of_all(c, m);
    text += "\n" + header_by_kind(c);
    for (const Measurement& m : c.measurements) {
        if (m.unavailable.empty()) text += line_by_kind(c, m);
    }
    return text + notes(c);
}

}  // namespace alhazen
