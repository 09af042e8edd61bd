/// Rays per second of wide_bvh beside Embree: same triangles, same rays, one thread, A B A B,
/// medians. Usage: alhazen_kernel_bench [MESH_FILE...] [--json FILE] [--side N] [--rounds N]
/// [--only RAYS]

#include <fmt/format.h>

#include <time.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/scene/accelerator_table.h"
#include "alhazen/scene/primitive_table.h"
#include "alhazen/session/stopwatch.h"
#include "kernel_rays.h"
#ifdef ALHAZEN_HAVE_EMBREE
#include "embree_tracer.h"
#endif

namespace {

using namespace alhazen;
using namespace alhazen::bench;
using json = nlohmann::ordered_json;

struct Arguments {
    std::vector<std::string> meshes;
    std::string json_file;
    std::string only;  ///< name of a ray set; empty: all
    int side = 512;
    int rounds = 5;
};

std::shared_ptr<const Aggregate> build(const KernelScene& scene) {
    PrimitiveTable table;
    table.meshes.push_back({std::make_shared<TriangleMesh>(scene.mesh), MaterialId{0}, 0, false});
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return make_aggregate("wide_bvh", std::move(table));
}

std::size_t trace(const Aggregate& aggregate, const RaySet& set) {
    std::size_t hits = 0;
    for (const Ray& ray : set.rays) {
        if (set.any_hit) {
            hits += aggregate.occluded(ray, nullptr);
        } else {
            Hit hit;
            hits += aggregate.closest(ray, hit, nullptr);
        }
    }
    return hits;
}

/// The same rays by the batch, as many at a time as a renderer's tile has.
std::size_t trace_batches(const Aggregate& aggregate, const RaySet& set) {
    constexpr std::size_t kBatch = 1024;
    std::vector<Hit> hits(kBatch);
    const auto occluded = std::make_unique<bool[]>(kBatch);
    std::size_t count = 0;
    for (std::size_t i = 0; i < set.rays.size(); i += kBatch) {
        const std::size_t n = std::min(kBatch, set.rays.size() - i);
        const std::span<const Ray> rays(&set.rays[i], n);
        if (set.any_hit) {
            aggregate.occluded_batch(rays, {occluded.get(), n}, nullptr);
            for (std::size_t k = 0; k < n; ++k) count += occluded[k];
        } else {
            aggregate.closest_batch(rays, std::span(hits).first(n), nullptr);
            for (std::size_t k = 0; k < n; ++k) count += hits[k].found();
        }
    }
    return count;
}

/// What a ray of the set costs on average, counted.
json count_work(const Aggregate& aggregate, const RaySet& set) {
    TraversalStats stats;
    for (const Ray& ray : set.rays) {
        Hit hit;
        if (set.any_hit) {
            (void)aggregate.occluded(ray, &stats);
        } else {
            (void)aggregate.closest(ray, hit, &stats);
        }
    }
    const auto per_ray = [&](std::uint64_t n) {
        return static_cast<double>(n) / static_cast<double>(set.rays.size());
    };
    return {{"node_visits", per_ray(stats.node_visits)},
            {"primitive_tests", per_ray(stats.primitive_tests)},
            {"primitive_hits", per_ray(stats.primitive_hits)}};
}

double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

/// Seconds that this thread has computed: what other programs take of the processor does not count.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Tracers in turn, round after round, so that a drift of the machine's speed meets them all alike.
template <class Tracers>
json measure(const RaySet& set, const Tracers& tracers, int rounds) {
    std::vector<std::vector<double>> rates(tracers.size());
    std::vector<std::size_t> hits(tracers.size());
    for (int round = 0; round <= rounds; ++round) {
        for (std::size_t i = 0; i < tracers.size(); ++i) {
            const double begin = processor_seconds();
            hits[i] = tracers[i].trace(set);
            const double seconds = processor_seconds() - begin;
            // The first round warms the caches.
            if (round > 0)
                rates[i].push_back(1e-6 * static_cast<double>(set.rays.size()) / seconds);
        }
    }
    json row = {{"rays", set.name}, {"count", set.rays.size()}};
    for (std::size_t i = 0; i < tracers.size(); ++i) {
        const auto [lo, hi] = std::minmax_element(rates[i].begin(), rates[i].end());
        row[tracers[i].name] = {
            {"mrays_per_s", median(rates[i])}, {"min", *lo}, {"max", *hi}, {"hits", hits[i]}};
    }
    return row;
}

struct Tracer {
    std::string name;
    std::function<std::size_t(const RaySet&)> trace;
};

json run(const KernelScene& scene, const Arguments& args) {
    const Stopwatch build_time;
    const auto aggregate = build(scene);
    json result = {{"scene", scene.name},
                   {"triangles", scene.mesh.triangles.size()},
                   {"build_seconds", {{"wide_bvh", build_time.seconds()}}},
                   {"bytes_per_triangle", static_cast<double>(aggregate->memory_bytes()) /
                                              static_cast<double>(scene.mesh.triangles.size())}};
    std::vector<Tracer> tracers{
        {"wide_bvh", [&](const RaySet& s) { return trace(*aggregate, s); }},
        {"wide_bvh_batch", [&](const RaySet& s) { return trace_batches(*aggregate, s); }}};
#ifdef ALHAZEN_HAVE_EMBREE
    const EmbreeTracer fast(scene.mesh, false), robust(scene.mesh, true);
    result["build_seconds"]["embree"] = fast.build_seconds();
    tracers.push_back({"embree_robust", [&](const RaySet& s) { return robust.trace(s); }});
    tracers.push_back({"embree_fast", [&](const RaySet& s) { return fast.trace(s); }});
#endif
    fmt::print("{}: {} triangles\n", scene.name, scene.mesh.triangles.size());
    for (const RaySet& set : ray_sets(scene, *aggregate, args.side)) {
        if (!args.only.empty() && set.name != args.only) continue;
        json row = measure(set, tracers, args.rounds);
        row["wide_bvh_per_ray"] = count_work(*aggregate, set);
        fmt::print("  {:<9} {:5.1f} nodes {:5.1f} tests per ray", set.name,
                   row["wide_bvh_per_ray"]["node_visits"].get<double>(),
                   row["wide_bvh_per_ray"]["primitive_tests"].get<double>());
        for (const Tracer& t : tracers) {
            fmt::print(" {:>14} {:7.3f} ({} hits)", t.name,
                       row[t.name]["mrays_per_s"].get<double>(),
                       row[t.name]["hits"].get<std::size_t>());
        }
        fmt::print("\n");
        result["sets"].push_back(std::move(row));
    }
    return result;
}

Arguments parse(int argc, char** argv) {
    Arguments args;
    for (int i = 1; i < argc; ++i) {
        const std::string a = argv[i];
        const auto value = [&] {
            if (i + 1 == argc) throw Error(ErrorKind::Usage, a + " needs a value");
            return std::string(argv[++i]);
        };
        if (a == "--json") {
            args.json_file = value();
        } else if (a == "--side") {
            args.side = std::stoi(value());
        } else if (a == "--only") {
            args.only = value();
        } else if (a == "--rounds") {
            args.rounds = std::stoi(value());
        } else {
            args.meshes.push_back(a);
        }
    }
    return args;
}

}  // namespace

int main(int argc, char** argv) try {
    const Arguments args = parse(argc, argv);
    json results = json::array();
    for (const std::string& file : args.meshes) {
        results.push_back(run(mesh_scene(std::filesystem::path(file).stem().string(), file), args));
    }
    if (args.meshes.empty() || args.only.empty()) {
        results.push_back(run(tessellated_balls(4, 1), args));
    }
    if (!args.json_file.empty()) write_file_atomically(args.json_file, results.dump(2) + "\n");
    return 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "kernel_bench: {}\n", error.what());
    return 1;
}
