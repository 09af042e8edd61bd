#include "alhazen/laboratory/claims/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "alhazen/base/error.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/laboratory/claims/claim_run.h"

namespace alhazen {
namespace {

constexpr std::array kClaims{
    ClaimEntry{"A1", "Whitted: most of the time is spent on intersections",
               "75 % or more with 100 and 1000 objects, more with more objects", &claim_a1},
    ClaimEntry{"A2", "1024 x 1024 rays and 100 objects are 100 M tests without a structure",
               "exactly 1024 x 1024 x 100", &claim_a2},
    ClaimEntry{"A3", "a hierarchy prunes", "100 times fewer tests of primitives than list, SPD",
               &claim_a3},
    ClaimEntry{"A4", "Kay and Kajiya: nearest bound first, by a heap",
               "tests of primitives: heap <= ordered <= unordered depth first", &claim_a4},
    ClaimEntry{"A5", "Kay and Kajiya: more slabs fit more tightly",
               "tests of primitives fall from 3 to 7 to 13 slabs, long diagonal objects",
               &claim_a5},
    ClaimEntry{"A6", "Kay and Kajiya: a test of slabs ends early",
               "fewer slabs are examined than there are", &claim_a6},
    ClaimEntry{"B1", "Goldsmith and Salmon: the cost of the example, and of every insertion",
               "7.8, and the increments add up", &claim_b1},
    ClaimEntry{"B2", "Goldsmith and Salmon: insertion beats dividing at medians",
               "cheaper in at least 5 of 7 SPD scenes, by cost and by tests of bounds", &claim_b2},
    ClaimEntry{"B3", "Goldsmith and Salmon: O(n log n)",
               "steps grow with an exponent of 1.0 to 1.15 from 10^3 to 10^6", &claim_b3},
    ClaimEntry{"B4", "Havran and Sixta: counts of uniform grids",
               "within 10 % of the published ones", &claim_b4},
    ClaimEntry{"B5", "mailboxes save tests", "fewer tests of primitives, equal answers", &claim_b5},
    ClaimEntry{"B6", "a hit must lie in the visited cell",
               "without the rule the image is wrong, and the comparison detects it", &claim_b6},
    ClaimEntry{"B7", "a teapot in a stadium defeats a uniform grid",
               "at least 20 times slower than a nested one", &claim_b7},
    ClaimEntry{
        "B8", "traversal of an octree",
        "steps of top-down traversal over those by point location within 10 % of the published "
        "0.35 to 0.47, balls",
        &claim_b8},
    ClaimEntry{"B9", "Wald and Havran: a k-d tree in O(n log n), the same as in O(n^2)",
               "equal bit for bit, exponent 1.0 to 1.1", &claim_b9},
    ClaimEntry{"B10", "arbitrary planes fit more tightly than axis-aligned ones",
               "fewer tests of primitives than the k-d tree, a slower build", &claim_b10},
    ClaimEntry{"B11", "Arvo and Kirk: rays classified in five dimensions",
               "fewer tests of primitives than the octree, 90 % of eye rays find their hypercube "
               "in the cache",
               &claim_b11},
    ClaimEntry{"B12", "Haines and Greenberg: the light buffer",
               "at least 4 times fewer tests per shadow ray", &claim_b12},
    ClaimEntry{"B13", "Ohta and Maekawa: ray coherence",
               "tests per ray nearly constant in the number of sparse spheres", &claim_b13},
    ClaimEntry{"B14", "Snyder and Barr: 2 x 10^9 primitives",
               "at most 100 MB, at most 3 times the time of 2 x 10^6", &claim_b14},
    ClaimEntry{"C1", "Lane and Carpenter: patches are split when a scan line meets them",
               "at least 5 times fewer patches and polygons in memory than with all split first",
               &claim_c1},
    ClaimEntry{"C2", "Clark: subdivision leaves cracks, straight edges leave none",
               "ground inside a closed surface: more than 0 pixels as it is, 0 with a tighter "
               "tolerance, 0 with Clark's edges",
               &claim_c2},
    ClaimEntry{"C3", "Lane and Carpenter: patches that are flat in one direction",
               "fewer polygons than by splitting in both, at equal error", &claim_c3},
    ClaimEntry{"C4", "Kajiya, Toth, Joy and others: crossings of patches, by method",
               "certified_newton misses and invents none of those counted in 113 bits", &claim_c4},
    ClaimEntry{"E1", "Amanatides: a cone a pixel instead of many rays",
               "RMSE of one cone per pixel at most that of 16 rays, checks to the horizon, poles, "
               "spheres",
               &claim_e1},
    ClaimEntry{"E2", "Kirk: covered areas from tables",
               "at least twice as fast as the formulas, off by at most 1e-3", &claim_e2},
    ClaimEntry{"E3", "Heckbert and Hanrahan: beams do not depend on the resolution, rays do",
               "equal beams from 128 x 128 to 1024 x 1024, 64 times the rays", &claim_e3},
    ClaimEntry{"E4", "Dadoun, Kirkpatrick and Walsh: hulls around the subtrees of a BSP tree",
               "at least 5 times fewer polygons tested per beam than by the tree alone", &claim_e4},
    ClaimEntry{"F1", "Whitted: rays where shades differ instead of everywhere",
               "at most half the rays of uniform sampling at equal error, 5 scenes", &claim_f1},
    ClaimEntry{"F2", "Whitted: bounding spheres that some eye ray meets",
               "each sphere of 0.05 pixels is in each of 64 frames; variance over time at least "
               "10 times less than without",
               &claim_f2},
    ClaimEntry{"F3", "Sobol and Owen: scrambled nets instead of independent samples",
               "half the samples of 64 independent ones at most, at equal error", &claim_f3},
    ClaimEntry{"F4", "rounds of samples where the noise is, on a sparse scene",
               "at least 1.5 times fewer samples than everywhere, at equal error", &claim_f4},
    ClaimEntry{"F5", "Cook, Porter and Carpenter: motion, by a tree that knows time",
               "at most 1.5 times the time of the still scene, where all things move a little",
               &claim_f5},
    ClaimEntry{"G2", "Hachisuka and Jensen, Knaus and Zwicker: how the error of passes falls",
               "exponent of the RMSE within 0.05 of -alpha / 2, of vcm on what can be joined of "
               "-1/2; bias that of the radii",
               &claim_g2},
    ClaimEntry{"G3", "no light is lost on its way",
               "power of photons that arrive within 0.5 % of that sent, a closed sphere within 1 %",
               &claim_g3},
    ClaimEntry{"H1", "instances cost almost no memory per effective primitive",
               "at most 0.01 bytes for each of 2 x 10^9", &claim_h1},
};

Verdict verdict_of(const ClaimReport& report) {
    bool any = false;
    for (const ClaimFinding& finding : report.findings) {
        if (finding.holds == false) return Verdict::Fails;
        any = any || finding.holds == true;
    }
    return any ? Verdict::Holds : Verdict::NotAvailable;
}

ClaimReport check(const ClaimEntry& entry, const ClaimOptions& options, TrialCache& trials) {
    ClaimReport report{entry.id, entry.claim, entry.expected};
    ClaimRun run(report, options, trials);
    const Stopwatch time;
    try {
        entry.run(run);
        report.verdict = verdict_of(report);
    } catch (const ClaimUnavailable& missing) {
        report.verdict = Verdict::NotAvailable;
        run.note(missing.what());
    }
    report.seconds = time.seconds();
    return report;
}

std::string finding_mark(const ClaimFinding& finding) {
    return !finding.holds ? "" : *finding.holds ? "yes" : "NO";
}

}  // namespace

std::span<const ClaimEntry> claims() {
    return kClaims;
}

const char* verdict_name(Verdict verdict) {
    switch (verdict) {
        case Verdict::Holds:
            return "holds";
        case Verdict::Fails:
            return "does not hold";
        case Verdict::NotAvailable:
            break;
    }
    return "not available";
}

std::vector<std::string> parse_claims(const std::string& list) {
    std::vector<std::string> ids;
    std::string known;
    for (const ClaimEntry& entry : claims()) {
        if (list == "all") ids.emplace_back(entry.id);
        known += known.empty() ? entry.id : std::string(", ") + entry.id;
    }
    if (!ids.empty()) return ids;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        const std::string id = list.substr(begin, end - begin);
        const auto entries = claims();
        if (std::none_of(entries.begin(), entries.end(),
                         [&](const ClaimEntry& entry) { return id == entry.id; })) {
            throw Error(ErrorKind::Usage,
                        fmt::format("no claim '{}'; the valid ids are: {}, all", id, known));
        }
        ids.push_back(id);
        begin = end + 1;
    }
    return ids;
}

std::vector<ClaimReport> check_claims(const std::vector<std::string>& ids,
                                      const ClaimOptions& options,
                                      const std::function<void(const ClaimReport&)>& done) {
    std::vector<ClaimReport> reports;
    TrialCache trials;
    for (const ClaimEntry& entry : claims()) {
        if (std::find(ids.begin(), ids.end(), entry.id) == ids.end()) continue;
        reports.push_back(check(entry, options, trials));
        if (done) done(reports.back());
    }
    return reports;
}

std::string claims_table(std::span<const ClaimReport> reports) {
    std::string text;
    for (const ClaimReport& r : reports) {
        text += fmt::format("{:<4} {}: {} ({:.1f} s)\n     expected: {}\n", r.id, r.claim,
                            verdict_name(r.verdict), r.seconds, r.expected);
        std::size_t widest = 0;
        for (const ClaimFinding& f : r.findings) widest = std::max(widest, f.what.size());
        for (const ClaimFinding& f : r.findings) {
            text +=
                fmt::format("     {:<{}}  {:<34}  {:<30} {}\n", f.what, widest, f.ours,
                            f.reference.empty() ? "" : "reference " + f.reference, finding_mark(f));
        }
        if (!r.note.empty()) text += "     " + r.note + "\n";
        text += "\n";
    }
    return text;
}

std::string claims_markdown(std::span<const ClaimReport> reports) {
    std::string text = "| id | claim | expected | verdict |\n|---|---|---|---|\n";
    for (const ClaimReport& r : reports) {
        text += fmt::format(
            "| {} | {} | {} | {} |\n", r.id, r.claim, r.expected,
            r.verdict == Verdict::Holds ? "holds" : fmt::format("**{}**", verdict_name(r.verdict)));
    }
    for (const ClaimReport& r : reports) {
        text += fmt::format("\n### {}: {}\n", r.id, r.claim);
        if (!r.findings.empty()) text += "| what | ours | reference | holds |\n|---|---|---|---|\n";
        for (const ClaimFinding& f : r.findings) {
            text += fmt::format("| {} | {} | {} | {} |\n", f.what, f.ours, f.reference,
                                finding_mark(f));
        }
        if (!r.note.empty()) text += (r.findings.empty() ? "" : "\n") + r.note + "\n";
    }
    return text;
}

}  // namespace alhazen
