/// Rays per second of wide_bvh and Embree: same scene, same rays, one thread, in turn, medians.
/// `single` and `batch` take rays as `Ray`, `columns` floats in columns.
/// Usage: alhazen_kernel_bench SCENE... [--side N] [--rounds N] [--only RAYS] [--json FILE]
///            [--markdown FILE] [--build fast|default|high] [--width 4|8|16] [--compact] [--masks]
///            [--target AVX3|AVX2|SSE4]
///        alhazen_kernel_bench SCENE... --instructions [--rays N] [--side N] [--only RAYS] ...
///        alhazen_kernel_bench SCENE... --check [--side N] [--only RAYS] [--markdown FILE]
/// SCENE: see kernel_scenes.h. --instructions counts those of some rays by single steps, the same
/// numbers in every run. --check measures no times: it counts the rays on which the tracers
/// disagree and resolves each disagreement by brute force in extended precision.

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "alhazen/base/file.h"
#include "alhazen/sampling/random.h"
#include "alhazen/simd/targets.h"
#include "command_line.h"
#include "instruction_count.h"
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
    bool masks = false;                     ///< also measures with masks
    std::string target;                     ///< instruction set of all tracers; empty: the best
    std::size_t counted_rays = 4 * kBatch;  ///< of each set, for --instructions
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

/// Our trees of a scene and those of the peer.
struct Trees {
    Trees(const KernelScene& scene, const Settings& settings)
        : robust(build_ours(scene, settings.build)),
          fast(build_ours(scene, with_float(settings.build))),
          masked(settings.masks ? build_masked(scene, settings.build) : nullptr),
          peers(scene, embree_isa(settings.target)) {}

    static BuildOptions with_float(BuildOptions options) {
        options.precision = Precision::Fast;
        return options;
    }

    std::shared_ptr<const Aggregate> robust, fast, masked;
    Peers peers;
};

/// All ways to trace a set, with their rays and results.
class SetTracers {
  public:
    SetTracers(const Trees& trees, const RaySet& set)
        : columns_(set), ours_(*trees.robust, set), fast_(*trees.fast, set) {
        list = our_contenders(ours_, fast_, columns_.rays());
        if (trees.masked != nullptr) {
            add_masked(masked_.emplace(*trees.masked, set, kSeeing), list);
        }
#ifdef ALHAZEN_HAVE_EMBREE
        add_peers(trees.peers, set, packets_, list);
#endif
    }
    SetTracers(const SetTracers&) = delete;
    SetTracers& operator=(const SetTracers&) = delete;

    std::vector<Contender> list;

  private:
    ColumnsOfRays columns_;
    OurTracer ours_, fast_;
    std::optional<OurTracer> masked_;
#ifdef ALHAZEN_HAVE_EMBREE
    std::vector<std::unique_ptr<EmbreePackets>> packets_;
#endif
};

std::vector<RaySet> sets_of(const KernelScene& scene, const Trees& trees,
                            const Settings& settings) {
    std::vector<RaySet> sets = ray_sets(scene, *trees.robust, settings.side);
    std::erase_if(sets, [&](const RaySet& set) {
        return set.rays.empty() || (!settings.only.empty() && set.name != settings.only);
    });
    return sets;
}

SceneResult run(const KernelScene& scene, const Settings& settings) {
    const Trees trees(scene, settings);
    SceneResult result{scene.name, scene.contents(), {}};
    fmt::print("{}: {}\n", scene.name, result.contents);
    for (const RaySet& set : sets_of(scene, trees, settings)) {
        const SetTracers tracers(trees, set);
        SetResult row{
            set.name, set.rays.size(), count_work(*trees.robust, set),
            measure(scene.name + " " + set.name, tracers.list, set.rays.size(), settings.rounds)};
        fmt::print("{}", as_text(row));
        std::fflush(stdout);
        result.sets.push_back(std::move(row));
    }
    return result;
}

/// Whole batches of the set at places drawn with a fixed seed: about `count` rays. Even steps would
/// stay in one column of the picture.
RaySet some_batches(const RaySet& set, std::size_t count) {
    const std::size_t all = set.rays.size() / kBatch;
    const std::size_t some = std::max<std::size_t>(count / kBatch, 1);
    if (all <= some) return set;
    RandomStream random(1);
    RaySet part{set.name, set.any_hit, set.coherent, {}};
    for (std::size_t i = 0; i < some; ++i) {
        const auto* first = set.rays.data() + random.below(all) * kBatch;
        part.rays.insert(part.rays.end(), first, first + kBatch);
    }
    return part;
}

InstructionResult count_set(const Trees& trees, const RaySet& set) {
    const SetTracers tracers(trees, set);
    InstructionResult row{set.name, set.rays.size(), {}};
    for (const Contender& t : tracers.list) {
        if (t.group != kOurs && t.group != kRobust) continue;
        const auto prepare = [&] {
            if (t.prepare) t.prepare();
        };
        // What is made at the first call is not counted.
        prepare();
        t.trace();
        const std::size_t hits = t.count_hits();
        prepare();
        const auto counted = static_cast<double>(count_instructions(t.trace));
        row.tracers.push_back(
            {t.group, t.name, hits, counted / static_cast<double>(set.rays.size())});
    }
    return row;
}

void run_instructions(const CommandLine& line, const Settings& settings, const RunFacts& facts) {
    check_instruction_count();
    std::vector<InstructionScene> scenes;
    for (const std::string& spec : line.rest) {
        const KernelScene scene = make_scene(spec);
        const Trees trees(scene, settings);
        InstructionScene& result =
            scenes.emplace_back(InstructionScene{scene.name, scene.contents(), {}});
        fmt::print("{}: {}\n", scene.name, result.contents);
        for (const RaySet& set : sets_of(scene, trees, settings)) {
            result.sets.push_back(count_set(trees, some_batches(set, settings.counted_rays)));
            fmt::print("{}", as_text(result.sets.back()));
            std::fflush(stdout);
        }
        const std::string markdown = line.text("--markdown", "");
        if (!markdown.empty()) write_file_atomically(markdown, as_markdown(facts, scenes));
    }
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
    const CommandLine line(argc, argv,
                           {"--side", "--rounds", "--only", "--json", "--markdown", "--build",
                            "--width", "--target", "--rays"},
                           {"--check", "--compact", "--instructions", "--masks"});
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
    settings.counted_rays = line.count("--rays", settings.counted_rays);
    std::optional<SimdTargetOverride> forced;
    if (!settings.target.empty()) forced.emplace(settings.target);
    if (line.has("--check")) {
        const std::size_t faults = run_checks(line, settings);
        fmt::print("{} faults of wide_bvh or of the judge\n", faults);
        return faults == 0 ? 0 : 1;
    }
    const RunFacts facts = run_facts(argc, argv, settings.rounds);
    if (line.has("--instructions")) {
        run_instructions(line, settings, facts);
        return 0;
    }
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
