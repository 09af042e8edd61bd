#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "alhazen/parallel/parallel.h"
#include "peer_version.h"

namespace alhazen::bench {

namespace {

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    std::string line;
    while (std::getline(file, line)) {
        if (!line.starts_with("model name")) continue;
        const std::size_t at = line.find(": ");
        if (at != std::string::npos) return line.substr(at + 2);
    }
    return "unknown processor";
}

/// The last component of a path, so that tables do not depend on the location of the data.
std::string file_name(const std::string& argument) {
    const std::size_t slash = argument.rfind('/');
    return slash == std::string::npos ? argument : argument.substr(slash + 1);
}

std::string number(const Measured* m) {
    return m == nullptr ? "-" : fmt::format("{:.2f}", m->spread().median);
}

std::string ratio(const Measured* a, const Measured* b) {
    if (a == nullptr || b == nullptr) return "-";
    return fmt::format("{:.2f}", a->spread().median / b->spread().median);
}

std::string best(const Measured* m) {
    return m == nullptr ? "-" : fmt::format("{:.2f} ({})", m->spread().median, m->name);
}

std::string quartiles(const Spread& s) {
    return fmt::format("{:.2f} to {:.2f} ({:.2f} to {:.2f})", s.lower, s.upper, s.min, s.max);
}

std::string spread_row(const SetResult& set) {
    const Measured* batch = find(set.tracers, kOurs, "batch");
    const Measured* peer = best_of(set.tracers, kRobust);
    std::string row;
    for (const Measured* m : {find(set.tracers, kOurs, "single"), batch, peer}) {
        row += m == nullptr ? " - |" : fmt::format(" {} |", quartiles(m->spread()));
    }
    if (batch == nullptr || peer == nullptr) return row + " - |";
    return row + fmt::format(" {} |", quartiles(ratio_by_round(*batch, *peer)));
}

/// The rates with masks, and their ratios to those without, round by round.
std::string masks_row(const SetResult& set) {
    std::string row;
    for (const char* name : {"single", "batch"}) {
        const Measured* masked = find(set.tracers, kOursMasked, name);
        const Spread ratio = ratio_by_round(*masked, *find(set.tracers, kOurs, name));
        row += fmt::format(" {} | {:.2f} ({:.2f} to {:.2f}) |", number(masked), ratio.median,
                           ratio.min, ratio.max);
    }
    return row;
}

bool has_masks(const std::vector<SceneResult>& scenes) {
    return !scenes.empty() && !scenes.front().sets.empty() &&
           find(scenes.front().sets.front().tracers, kOursMasked, "single") != nullptr;
}

/// The tracers whose number of hits differs from ours, with the difference.
std::string hit_differences(const SetResult& set) {
    std::string text;
    const std::size_t ours = set.tracers.front().hits;
    for (const Measured& m : set.tracers) {
        if (m.hits == ours) continue;
        const auto difference = static_cast<long long>(m.hits) - static_cast<long long>(ours);
        text += fmt::format("{}{} {}: {:+}", text.empty() ? "" : ", ", m.group, m.name, difference);
    }
    return text;
}

/// One row per set; only the first row of a scene contains its name.
template <class Scene, class Cells>
std::string rows(const std::vector<Scene>& scenes, Cells&& cells) {
    std::string text;
    for (const Scene& scene : scenes) {
        for (const auto& set : scene.sets) {
            const bool first = &set == &scene.sets.front();
            text += fmt::format("| {} | {} |{}\n",
                                first ? fmt::format("{}: {}", scene.name, scene.contents) : "",
                                set.rays, cells(set));
        }
    }
    return text;
}

/// The best of Embree's robust single-ray tracers.
const Measured* best_single(const SetResult& set) {
    const Measured* best = nullptr;
    for (const Measured& m : set.tracers) {
        const bool single = m.name == "1" || m.name.starts_with("1 ") || m.name.starts_with("1,");
        if (m.group != kRobust || !single) continue;
        if (best == nullptr || m.spread().median > best->spread().median) best = &m;
    }
    return best;
}

std::string medians_row(const SetResult& set) {
    const Measured* single = find(set.tracers, kOurs, "single");
    const Measured* batch = find(set.tracers, kOurs, "batch");
    const Measured* columns = find(set.tracers, kOurs, "columns");
    const Measured* robust = best_of(set.tracers, kRobust);
    const Measured* robust1 = best_single(set);
    const Measured* fast = find(set.tracers, kOursFast, "single");
    const Measured* fast_batch = find(set.tracers, kOursFast, "batch");
    return fmt::format(" {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
                       number(single), number(batch), number(columns), number(robust1),
                       best(robust), best(best_of(set.tracers, kFast)), ratio(single, robust1),
                       ratio(single, robust), ratio(batch, robust), ratio(columns, robust),
                       ratio(single, fast), ratio(batch, fast_batch));
}

/// Null if there is none.
const Counted* find(const InstructionResult& set, const std::string& group,
                    const std::string& name) {
    const auto place = std::ranges::find_if(set.tracers, [&](const Counted& c) {
        return c.group == group && (c.name == name || c.name.starts_with(name + ","));
    });
    return place == set.tracers.end() ? nullptr : &*place;
}

/// The peer's robust call of the fewest instructions, among those with the right number of hits.
const Counted* least_robust(const InstructionResult& set) {
    const Counted* least = nullptr;
    const auto expected = static_cast<double>(set.tracers.front().hits);
    for (const Counted& c : set.tracers) {
        const bool right = std::abs(static_cast<double>(c.hits) - expected) <= 0.005 * expected;
        if (c.group != kRobust || !right) continue;
        if (least == nullptr || c.per_ray < least->per_ray) least = &c;
    }
    return least;
}

std::string whole(const Counted* c) {
    return c == nullptr ? "-" : fmt::format("{:.0f}", c->per_ray);
}

std::string quotient(const Counted* a, const Counted* b) {
    if (a == nullptr || b == nullptr) return "-";
    return fmt::format("{:.2f}", a->per_ray / b->per_ray);
}

std::string instructions_row(const InstructionResult& set) {
    const Counted *single = find(set, kOurs, "single"), *batch = find(set, kOurs, "batch");
    const Counted *columns = find(set, kOurs, "columns"), *robust1 = find(set, kRobust, "1");
    const Counted* least = least_robust(set);
    return fmt::format(
        " {} | {} | {} | {} | {} | {} | {} | {} |", whole(single), whole(batch), whole(columns),
        whole(robust1),
        least == nullptr ? "-" : fmt::format("{:.0f} ({})", least->per_ray, least->name),
        quotient(single, robust1), quotient(batch, least), quotient(columns, least));
}

}  // namespace

RunFacts run_facts(int argc, char** argv, int rounds) {
    RunFacts facts;
    for (int i = 0; i < argc; ++i) {
        if (i > 0) facts.command += ' ';
        facts.command += file_name(argv[i]);
    }
    facts.machine =
        fmt::format("{}, {} cores, {}", processor_name(), available_cores(), peer_version());
    facts.rounds = rounds;
    return facts;
}

std::string as_text(const SetResult& set) {
    std::string text = fmt::format("  {:<9}{:6.1f} nodes {:5.1f} tests per ray\n", set.rays,
                                   set.work.node_visits, set.work.primitive_tests);
    for (const Measured& m : set.tracers) {
        const Spread s = m.spread();
        text += fmt::format("    {:<14}{:<20}{:8.3f} M/s  [{:.3f}, {:.3f}]  {} hits\n", m.group,
                            m.name, s.median, s.lower, s.upper, m.hits);
    }
    return text;
}

nlohmann::ordered_json as_json(const RunFacts& facts, const std::vector<SceneResult>& scenes) {
    nlohmann::ordered_json result = {{"command", facts.command},
                                     {"machine", facts.machine},
                                     {"rounds", facts.rounds},
                                     {"scenes", nlohmann::ordered_json::array()}};
    for (const SceneResult& scene : scenes) {
        nlohmann::ordered_json sets = nlohmann::ordered_json::array();
        for (const SetResult& set : scene.sets) {
            nlohmann::ordered_json row = {{"rays", set.rays},
                                          {"count", set.count},
                                          {"node_visits", set.work.node_visits},
                                          {"primitive_tests", set.work.primitive_tests},
                                          {"primitive_hits", set.work.primitive_hits}};
            for (const Measured& m : set.tracers) {
                const Spread s = m.spread();
                row["tracers"].push_back({{"group", m.group},
                                          {"name", m.name},
                                          {"mrays_per_s", s.median},
                                          {"lower_quartile", s.lower},
                                          {"upper_quartile", s.upper},
                                          {"min", s.min},
                                          {"max", s.max},
                                          {"hits", m.hits}});
            }
            sets.push_back(std::move(row));
        }
        result["scenes"].push_back(
            {{"scene", scene.name}, {"contents", scene.contents}, {"sets", std::move(sets)}});
    }
    return result;
}

std::string as_markdown(const RunFacts& facts, const std::vector<SceneResult>& scenes) {
    std::string text = fmt::format(
        "`{}`\n\n{}. One thread, million rays per second of its processor time, medians of {} "
        "rounds in turn. `best` is the fastest of `rtcIntersect1`, `4`, `8`, `16` (or "
        "`rtcOccluded`), the way in brackets, among those that find what they should (within 0.5 "
        "%).\n\n",
        facts.command, facts.machine, facts.rounds);
    text +=
        "| scene | rays | `wide_bvh` single | batch | columns | Embree robust 1 | robust best | "
        "fast best | single / robust 1 | single / robust best | batch / robust best | "
        "columns / robust best | single / our fast | batch / our fast |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    text += rows(scenes, medians_row);
    text +=
        "\nQuartiles (and least to greatest) of the rounds:\n\n"
        "| scene | rays | single | batch | robust best | batch / robust best, round by round |\n"
        "|---|---|---|---|---|---|\n";
    text += rows(scenes, spread_row);
    if (has_masks(scenes)) {
        text +=
            "\nThrough masks, of which one triangle has another one:\n\n"
            "| scene | rays | single | over that without | batch | over that without |\n"
            "|---|---|---|---|---|---|\n";
        text += rows(scenes, masks_row);
    }
    std::string differences;
    for (const SceneResult& scene : scenes) {
        for (const SetResult& set : scene.sets) {
            const std::string line = hit_differences(set);
            if (line.empty()) continue;
            differences += fmt::format("| {} | {} | {} of {} | {} |\n", scene.name, set.rays,
                                       set.tracers.front().hits, set.count, line);
        }
    }
    if (differences.empty()) {
        return text + "\nAll tracers have the same number of hits in every row.\n";
    }
    return text +
           "\nWhere the numbers of hits differ:\n\n| scene | rays | hits of ours | Embree |\n"
           "|---|---|---|---|\n" +
           differences;
}

std::string as_text(const InstructionResult& set) {
    std::string text = fmt::format("  {}: {} rays\n", set.rays, set.count);
    for (const Counted& c : set.tracers) {
        text += fmt::format("    {:<14}{:<20}{:9.1f} instructions per ray  {} hits\n", c.group,
                            c.name, c.per_ray, c.hits);
    }
    return text;
}

std::string as_markdown(const RunFacts& facts, const std::vector<InstructionScene>& scenes) {
    return fmt::format(
               "`{}`\n\n{}. Instructions per ray, counted by single steps. `least`: the call of "
               "Embree's robust mode that takes the fewest.\n\n"
               "| scene | rays | `wide_bvh` single | batch | columns | Embree robust 1 | robust "
               "least | single / robust 1 | batch / robust least | columns / robust least |\n"
               "|---|---|---|---|---|---|---|---|---|---|\n",
               facts.command, facts.machine) +
           rows(scenes, instructions_row);
}

}  // namespace alhazen::bench
