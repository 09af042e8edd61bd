/// Rays per second of wide_bvh and Embree: same scene, same rays, one thread, in turn, medians.
/// `single` and `batch` take rays as `Ray`, `columns` floats in columns.
/// Usage: alhazen_kernel_bench SCENE... [--side N] [--rounds N] [--only RAYS] [--json FILE]
///            [--markdown FILE] [--build fast|default|high] [--width 4|8|16] [--compact] [--masks]
///            [--target AVX3|AVX2|SSE4]
///        alhazen_kernel_bench SCENE... --check [--side N] [--only RAYS] [--markdown FILE]
/// SCENE: see kernel_scenes.h. --check measures no times: it counts the rays on which the tracers
/// disagree and resolves each disagreement by brute force in extended precision.

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "alhazen/base/file.h"
#include "alhazen/simd/targets.h"
#include "command_line.h"
#include "report.h"
#ifdef ALHAZEN_HAVE_EMBREE
#include "check.h"
#include "embree/embree_packets.h"
#endif

namespace {

using namespace alhazen;
using namespace alhazen::bench;

struct Settings {
    int side = 512;
    int rounds = 5;
    std::string only;  ///< name of a ray set; empty: all
    BuildOptions build{BuildQuality::High};
    bool masks = false;  ///< also measures with masks
    std::string target;  ///< instruction set of all tracers; empty: the best
};

/// Embree's name of a target.
std::string embree_isa(const std::string& target) {
    if (target == "AVX3") return "avx512";
    if (target == "AVX2") return "avx2";
    return target == "SSE4" ? "sse4.2" : "";
}

/// Both trees of Embree and, if there are cylinders, both representations of them.
class Peers {
  public:
    explicit Peers([[maybe_unused]] const KernelScene& scene,
                   [[maybe_unused]] const std::string& isa) {
#ifdef ALHAZEN_HAVE_EMBREE
        for (const bool robust : {true, false}) {
            for (const bool curves : {false, true}) {
                if (curves && scene.cylinders.empty()) continue;
                EmbreeOptions options;
                options.robust = robust;
                options.cylinders_are_curves = curves;
                options.isa = isa;
                scenes_.push_back(std::make_unique<EmbreeScene>(scene, options));
                std::string suffix;
                if (!scene.cylinders.empty()) suffix = curves ? ", curves" : ", user geometry";
                list.push_back({robust ? kRobust : kFast, suffix, scenes_.back().get()});
            }
        }
#endif
    }

#ifdef ALHAZEN_HAVE_EMBREE
    std::vector<PeerScene> list;

  private:
    std::vector<std::unique_ptr<EmbreeScene>> scenes_;
#endif
};

std::vector<Contender> our_contenders(OurTracer& ours, OurTracer& fast, const RayColumns& columns) {
    return {
        our_contender(kOurs, "single", [&](bool counts) { return ours.single(counts); }),
        our_contender(kOurs, "batch", [&](bool counts) { return ours.batches(counts); }),
        our_contender(kOurs, "columns", [&](bool counts) { return ours.columns(columns, counts); }),
        our_contender(kOursFast, "single", [&](bool counts) { return fast.single(counts); }),
        our_contender(kOursFast, "batch", [&](bool counts) { return fast.batches(counts); })};
}

void add_masked(OurTracer& masked, std::vector<Contender>& tracers) {
    tracers.push_back(
        our_contender(kOursMasked, "single", [&](bool counts) { return masked.single(counts); }));
    tracers.push_back(
        our_contender(kOursMasked, "batch", [&](bool counts) { return masked.batches(counts); }));
}

#ifdef ALHAZEN_HAVE_EMBREE
/// Adds all ways to trace the set in Embree; tracers of one packet width share the packed rays.
void add_peers(const Peers& peers, const RaySet& set,
               std::vector<std::unique_ptr<EmbreePackets>>& packets,
               std::vector<Contender>& tracers) {
    for (const int width : kPacketWidths) {
        packets.push_back(make_embree_packets(set, width));
        EmbreePackets* rays = packets.back().get();
        const auto add = [&](const PeerScene& peer, bool coherent, const char* flag) {
            RTCScene scene = peer.scene->handle();
            tracers.push_back({peer.group, fmt::format("{}{}{}", width, flag, peer.suffix),
                               [rays] { rays->reset(); },
                               [rays, scene, coherent] { rays->trace(scene, coherent); },
                               [rays] { return rays->count_hits(); }});
        };
        for (const PeerScene& peer : peers.list) {
            // The flag selects between packet kernels; single rays are measured with both values.
            add(peer, set.coherent && width > 1, "");
            if (width == 1 && set.coherent) add(peer, true, " coherent");
        }
    }
}
#endif

SceneResult run(const KernelScene& scene, const Settings& settings) {
    const auto aggregate = build_ours(scene, settings.build);
    BuildOptions fast_options = settings.build;
    fast_options.precision = Precision::Fast;
    const auto fast = build_ours(scene, fast_options);
    const auto masked = settings.masks ? build_masked(scene, settings.build) : nullptr;
    const Peers peers(scene, embree_isa(settings.target));
    SceneResult result{scene.name, scene.contents(), {}};
    fmt::print("{}: {}\n", scene.name, result.contents);
    for (const RaySet& set : ray_sets(scene, *aggregate, settings.side)) {
        if (!settings.only.empty() && set.name != settings.only) continue;
        if (set.rays.empty()) continue;
        const ColumnsOfRays columns(set);
        OurTracer ours(*aggregate, set), ours_fast(*fast, set);
        std::vector<Contender> tracers = our_contenders(ours, ours_fast, columns.rays());
        std::optional<OurTracer> ours_masked;
        if (masked != nullptr) add_masked(ours_masked.emplace(*masked, set, kSeeing), tracers);
#ifdef ALHAZEN_HAVE_EMBREE
        std::vector<std::unique_ptr<EmbreePackets>> packets;
        add_peers(peers, set, packets, tracers);
#endif
        SetResult row{set.name, set.rays.size(), count_work(*aggregate, set),
                      measure(tracers, set.rays.size(), settings.rounds)};
        fmt::print("{}", as_text(row));
        std::fflush(stdout);
        result.sets.push_back(std::move(row));
    }
    return result;
}

/// Returns the number of rays that wide_bvh gets wrong plus that of undetected planted errors.
std::size_t run_checks([[maybe_unused]] const CommandLine& line,
                       [[maybe_unused]] const Settings& settings) {
#ifdef ALHAZEN_HAVE_EMBREE
    std::vector<CheckResult> all;
    std::size_t faults = 0;
    for (const std::string& spec : line.rest) {
        const KernelScene scene = make_scene(spec);
        const auto aggregate = build_ours(scene, settings.build);
        const Peers peers(scene, embree_isa(settings.target));
        for (const RaySet& set : ray_sets(scene, *aggregate, settings.side)) {
            if (set.rays.empty() || (!settings.only.empty() && set.name != settings.only)) continue;
            const std::vector<CheckResult> results = check(scene, *aggregate, set, peers.list);
            for (const CheckResult& r : results) {
                fmt::print("{} {} {}: {} of {} differ, {} by Embree, {} by ours\n", r.scene, r.rays,
                           r.peer, r.disagreements, r.count, r.peer_wrong, r.ours_wrong);
            }
            for (const CheckResult& r : results) {
                faults += r.ours_wrong + r.batch_differs + r.planted_unseen;
                for (const std::string& fault : r.our_faults) fmt::print("OURS: {}\n", fault);
                for (const std::string& ray : r.unseen) fmt::print("UNSEEN: {}\n", ray);
            }
            std::fflush(stdout);
            all.insert(all.end(), results.begin(), results.end());
        }
    }
    const std::string file = line.text("--markdown", "");
    fmt::print("{}", as_markdown(all));
    if (!file.empty()) write_file_atomically(file, as_markdown(all));
    return faults;
#else
    throw Error(ErrorKind::Usage, "--check needs a build with Embree");
#endif
}

int run_program(int argc, char** argv) {
    const CommandLine line(
        argc, argv,
        {"--side", "--rounds", "--only", "--json", "--markdown", "--build", "--width", "--target"},
        {"--check", "--compact", "--masks"});
    if (line.rest.empty()) {
        throw Error(ErrorKind::Usage, fmt::format("no scene; scenes are {}", kSceneSpecs));
    }
    Settings settings;
    settings.side = static_cast<int>(line.count("--side", 512));
    settings.rounds = static_cast<int>(line.count("--rounds", 5));
    settings.only = line.text("--only", "");
    settings.build.quality =
        find_build_quality(line.text("--build", name_of(settings.build.quality)));
    settings.build.width = static_cast<std::uint32_t>(line.count("--width", 8));
    if (line.has("--compact")) settings.build.leaves = Leaves::Indices;
    settings.masks = line.has("--masks");
    settings.target = line.text("--target", "");
    std::optional<SimdTargetOverride> forced;
    if (!settings.target.empty()) forced.emplace(settings.target);
    if (line.has("--check")) {
        const std::size_t faults = run_checks(line, settings);
        fmt::print("{} faults of wide_bvh or of the judge\n", faults);
        return faults == 0 ? 0 : 1;
    }
    const RunFacts facts = run_facts(argc, argv, settings.rounds);
    std::vector<SceneResult> scenes;
    for (const std::string& spec : line.rest) {
        scenes.push_back(run(make_scene(spec), settings));
        // Written after every scene, so that an interrupted run keeps its results.
        const std::string json = line.text("--json", ""), markdown = line.text("--markdown", "");
        if (!json.empty()) write_file_atomically(json, as_json(facts, scenes).dump(2) + "\n");
        if (!markdown.empty()) write_file_atomically(markdown, as_markdown(facts, scenes));
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) try {
    return run_program(argc, argv);
} catch (const std::exception& error) {
    fmt::print(stderr, "kernel_bench: {}\n", error.what());
    return 1;
}
