/// Rays that leave closed meshes through vertices and edges: wide_bvh and Embree.
/// Usage: alhazen_leak_bench MESH... [--rays N] [--embree-rays N] [--markdown FILE]
/// MESH: a closed mesh file, or sphere:SPLITS. --rays is the total over all meshes (1e9 is
/// accepted); --embree-rays limits the rays that Embree also traces (default: all). Uses all cores.
/// --first-block N starts with other rays, so that a long run can be split into short ones.

#include <fmt/format.h>

#include <atomic>
#include <filesystem>
#include <mutex>

#include "alhazen/base/file.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/formats/mesh_files/mesh_io.h"
#include "alhazen/parallel/parallel.h"
#include "command_line.h"
#include "leak_mesh.h"
#include "measure.h"
#include "mesh_makers.h"
#include "our_tracer.h"
#include "peer_version.h"
#ifdef ALHAZEN_HAVE_EMBREE
#include "embree/embree_packets.h"
#include "embree/embree_scene.h"
#endif

namespace {

using namespace alhazen;
using namespace alhazen::bench;

/// Rays of one kind that a task generates and every tracer traces.
constexpr std::size_t kBlock = 4096;
constexpr std::size_t kShown = 5;

/// Counts the rays of a list that hit nothing.
struct LeakContender {
    std::string name;
    std::function<std::size_t(RaySet&)> count_misses;
    bool is_ours = false;
};

struct LeakRow {
    std::string mesh;
    LeakKind kind;
    std::vector<std::atomic<std::uint64_t>> rays, misses, nanoseconds;  ///< [tracer]

    LeakRow(std::string name, LeakKind k, std::size_t tracers)
        : mesh(std::move(name)), kind(k), rays(tracers), misses(tracers), nanoseconds(tracers) {}
};

std::vector<LeakContender> our_tracers(const Aggregate& aggregate) {
    const auto batch = [&aggregate](bool any_hit) {
        return [&aggregate, any_hit](RaySet& set) {
            set.any_hit = any_hit;
            return set.rays.size() - OurTracer(aggregate, set).batches(true);
        };
    };
    return {{"wide_bvh closest", batch(false), true}, {"wide_bvh occluded", batch(true), true}};
}

#ifdef ALHAZEN_HAVE_EMBREE
LeakContender embree_tracer(const EmbreeScene& scene, const char* mode, int width) {
    return {fmt::format("Embree {}, rtcIntersect{}", mode, width), [&scene, width](RaySet& s) {
                s.any_hit = false;
                const auto packets = make_embree_packets(s, width);
                packets->trace(scene.handle(), false);
                return s.rays.size() - packets->count_hits();
            }};
}
#endif

void show_leaks(const Aggregate& aggregate, const RaySet& set) {
    static std::mutex mutex;
    static std::size_t shown = 0;
    const std::lock_guard lock(mutex);
    for (const Ray& r : set.rays) {
        Hit hit;
        if (shown == kShown || aggregate.closest(r, hit, nullptr)) continue;
        ++shown;
        fmt::print("LEAK: origin {:a} {:a} {:a} direction {:a} {:a} {:a}\n", r.origin.x, r.origin.y,
                   r.origin.z, r.direction.x, r.direction.y, r.direction.z);
    }
}

/// Traces one block of rays by all tracers or, without `peers_too`, only by ours.
void run_block(const LeakMesh& mesh, const Aggregate& aggregate, std::uint64_t block,
               bool peers_too, const std::vector<LeakContender>& tracers,
               std::vector<std::unique_ptr<LeakRow>>& rows) {
    LeakRow& row = *rows[block % kLeakKinds];
    RandomStream random(mix64(block));
    RaySet set{"leaks", false, false, {}};
    for (std::size_t i = 0; i < kBlock; ++i) set.rays.push_back(mesh.ray(row.kind, random));
    for (std::size_t t = 0; t < tracers.size(); ++t) {
        if (!tracers[t].is_ours && !peers_too) continue;
        const double begin = processor_seconds();
        const std::size_t misses = tracers[t].count_misses(set);
        row.nanoseconds[t] += static_cast<std::uint64_t>(1e9 * (processor_seconds() - begin));
        row.rays[t] += set.rays.size();
        row.misses[t] += misses;
        if (misses > 0 && tracers[t].is_ours) show_leaks(aggregate, set);
    }
}

std::string head(const std::vector<LeakContender>& tracers) {
    std::string text = "| mesh | rays at | number |", rule = "|---|---|---|";
    for (const LeakContender& t : tracers) {
        text += fmt::format(" {} |", t.name);
        rule += "---|";
    }
    return text + "\n" + rule + "\n";
}

std::string cells(const LeakRow& row) {
    std::string text = fmt::format("| {} | {} | {:.3g} |", row.mesh, name_of(row.kind),
                                   static_cast<double>(row.rays[0].load()));
    for (std::size_t t = 0; t < row.rays.size(); ++t) {
        const std::uint64_t rays = row.rays[t], misses = row.misses[t];
        text += fmt::format(" {}", misses);
        if (rays != row.rays[0]) text += fmt::format(" of {:.3g}", static_cast<double>(rays));
        text += " |";
    }
    return text + "\n";
}

/// Rays per second of processor time of one thread, including the preparation of Embree's packets.
std::string rates(const std::vector<LeakContender>& tracers,
                  const std::vector<std::unique_ptr<LeakRow>>& rows) {
    std::string text;
    for (std::size_t t = 0; t < tracers.size(); ++t) {
        double rays = 0, nanoseconds = 1;
        for (const auto& row : rows) {
            rays += static_cast<double>(row->rays[t].load());
            nanoseconds += static_cast<double>(row->nanoseconds[t].load());
        }
        text += fmt::format("  {}: {:.2f} million rays per second and thread\n", tracers[t].name,
                            1e3 * rays / nanoseconds);
    }
    return text;
}

LeakMesh read_leak_mesh(const std::string& spec) {
    if (spec.starts_with("sphere:")) {
        return {spec, icosphere(std::clamp(std::atoi(spec.c_str() + 7), 0, 9))};
    }
    Diagnostics diagnostics;
    TriangleMesh mesh = read_mesh(spec, {}, diagnostics);
    diagnostics.throw_if_errors();
    return {std::filesystem::path(spec).stem().string(), std::move(mesh)};
}

struct Outcome {
    std::string markdown;
    std::uint64_t our_misses = 0;
};

void run(const std::string& spec, std::size_t rays, std::size_t embree_rays,
         std::size_t first_block, Outcome& outcome) {
    const LeakMesh mesh = read_leak_mesh(spec);
    KernelScene scene;
    scene.mesh = mesh.mesh();
    const auto aggregate = build_ours(scene);
    std::vector<LeakContender> tracers = our_tracers(*aggregate);
#ifdef ALHAZEN_HAVE_EMBREE
    EmbreeOptions options;
    const EmbreeScene robust(scene, options);
    options.robust = false;
    const EmbreeScene fast(scene, options);
    tracers.push_back(embree_tracer(robust, "robust", 1));
    tracers.push_back(embree_tracer(robust, "robust", 16));
    tracers.push_back(embree_tracer(fast, "fast", 1));
#endif
    std::vector<std::unique_ptr<LeakRow>> rows;
    for (int kind = 0; kind < kLeakKinds; ++kind) {
        rows.push_back(
            std::make_unique<LeakRow>(mesh.name(), static_cast<LeakKind>(kind), tracers.size()));
    }
    const std::size_t blocks = (rays + kBlock - 1) / kBlock;
    const std::size_t embree_blocks = (embree_rays + kBlock - 1) / kBlock;
    const Stopwatch time;
    parallel_for(blocks, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            run_block(mesh, *aggregate, first_block + b, b < embree_blocks, tracers, rows);
        }
    });
    const double rate = 1e-6 * static_cast<double>(blocks * kBlock) / time.seconds();
    if (outcome.markdown.empty()) outcome.markdown = head(tracers);
    fmt::print("{}: {} triangles, {:.3f} million rays per second by all tracers together\n",
               mesh.name(), scene.mesh.triangles.size(), rate);
    for (const auto& row : rows) {
        outcome.markdown += cells(*row);
        fmt::print("  {}", cells(*row));
        for (std::size_t t = 0; t < tracers.size(); ++t) {
            if (tracers[t].is_ours) outcome.our_misses += row->misses[t];
        }
    }
    fmt::print("{}", rates(tracers, rows));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
    const CommandLine line(argc, argv, {"--rays", "--embree-rays", "--first-block", "--markdown"});
    if (line.rest.empty()) throw Error(ErrorKind::Usage, "no mesh given");
    const std::size_t rays = line.count("--rays", 10'000'000) / line.rest.size();
    const std::size_t embree_rays = line.count("--embree-rays", rays * line.rest.size());
    const std::size_t first_block = line.has("--first-block") ? line.count("--first-block", 1) : 0;
    Outcome outcome;
    const std::string file = line.text("--markdown", "");
    for (const std::string& spec : line.rest) {
        run(spec, rays, embree_rays / line.rest.size(), first_block, outcome);
        if (!file.empty()) write_file_atomically(file, outcome.markdown);
    }
    fmt::print("{} rays got out of wide_bvh\n", outcome.our_misses);
    return outcome.our_misses == 0 ? 0 : 1;
} catch (const std::exception& error) {
    fmt::print(stderr, "leak_bench: {}\n", error.what());
    return 1;
}
