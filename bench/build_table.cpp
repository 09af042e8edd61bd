/// Building compared with Embree: seconds with one thread and with several, bytes and cost of the
/// tree.
/// Usage: alhazen_build_table SCENE... [--rounds N] [--threads N] [--only TEXT] [--markdown FILE]
/// SCENE: see kernel_scenes.h; triangles only. Builders take turns; --threads is the larger of the
/// two thread counts; --only selects the builders with TEXT in their names.

#include <fmt/format.h>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/base/file.h"
#include "alhazen/base/heap.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/bounded_primitives.h"
#include "command_line.h"
#include "kernel_scenes.h"
#include "measure.h"
#include "peer_version.h"
#ifdef ALHAZEN_HAVE_EMBREE
#include "embree/embree_scene.h"
#include "embree/embree_tree_cost.h"
#endif

namespace {

using namespace alhazen;
using namespace alhazen::bench;

// Width of the triangle blocks of wide_bvh and their cost, by which all trees are measured.
constexpr std::size_t kBlockWidth = 8;
constexpr double kBlockCost = 1.5;

struct Built {
    double seconds = 0;
    double bytes = 0;
};

struct Builder {
    std::string name;
    std::function<Built(int threads)> build;
    std::function<double()> cost;
};

PrimitiveTable table_of(const KernelScene& scene) {
    PrimitiveTable table;
    table.meshes.push_back({std::make_shared<TriangleMesh>(scene.mesh), MaterialId{0}, 0, false});
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return table;
}

/// The complete build, including the boxes of the primitives.
WideBvhLayout build_layout(const PrimitiveTable& table, const BuildOptions& options) {
    const BoundedPrimitives bounded(table);
    return build_wide_bvh(table, bounded, options);
}

Builder our_builder(const PrimitiveTable& table, const char* name, const BuildOptions& options) {
    return {fmt::format("wide_bvh {}", name),
            [&table, options](int threads) {
                WideBvhLayout layout;
                double seconds = 0;
                ThreadLimit(threads).run([&] {
                    const Stopwatch time;
                    layout = build_layout(table, options);
                    seconds = time.seconds();
                });
                return Built{seconds, static_cast<double>(layout.memory_bytes())};
            },
            [&table, options] { return build_layout(table, options).sah_cost(); }};
}

std::vector<Builder> our_builders(const PrimitiveTable& table) {
    std::vector<Builder> builders;
    for (const BuildQualityEntry& e : build_quality_table()) {
        builders.push_back(our_builder(table, e.name, {e.quality}));
    }
    builders.push_back(our_builder(table, "default, indices",
                                   {BuildQuality::Default, Precision::Robust, Leaves::Indices}));
    return builders;
}

#ifdef ALHAZEN_HAVE_EMBREE
Builder embree_builder(const KernelScene& scene, RTCBuildQuality quality, bool robust,
                       const char* name) {
    const bool no_splits = robust && quality == RTC_BUILD_QUALITY_HIGH;
    const RTCBuildQuality tree = no_splits ? RTC_BUILD_QUALITY_MEDIUM : quality;
    return {name,
            [&scene, quality, robust](int threads) {
                EmbreeOptions options;
                options.quality = quality;
                options.robust = robust;
                options.threads = threads;
                const EmbreeScene built(scene, options);
                return Built{built.build_seconds(), static_cast<double>(built.memory_bytes())};
            },
            [&scene, tree] { return embree_tree_cost(scene.mesh, tree, kBlockWidth, kBlockCost); }};
}
#endif

std::string row(const KernelScene& scene, const Builder& builder, const Spread& one,
                const Spread& many, double bytes) {
    const auto triangles = static_cast<double>(scene.mesh.triangles.size());
    return fmt::format(
        "| {}: {} | {} | {:.3f} ({:.3f} to {:.3f}) | {:.3f} ({:.3f} to {:.3f}) | "
        "{:.2f} | {:.1f} | {:.2f} |\n",
        scene.name, scene.contents(), builder.name, one.median, one.min, one.max, many.median,
        many.min, many.max, 1e-6 * triangles / many.median, bytes / triangles, builder.cost());
}

std::string run(const KernelScene& scene, int rounds, int threads, const std::string& only) {
    if (scene.mesh.triangles.empty()) throw Error(ErrorKind::Usage, scene.name + ": no triangles");
    const PrimitiveTable table = table_of(scene);
    std::vector<Builder> builders = our_builders(table);
#ifdef ALHAZEN_HAVE_EMBREE
    builders.push_back(embree_builder(scene, RTC_BUILD_QUALITY_LOW, true, "Embree low"));
    builders.push_back(embree_builder(scene, RTC_BUILD_QUALITY_MEDIUM, true, "Embree medium"));
    builders.push_back(embree_builder(scene, RTC_BUILD_QUALITY_HIGH, true, "Embree high"));
    // Embree's robust scenes of quality high have no spatial splits, and the same bytes and seconds
    // as medium; its fast scenes have them.
    builders.push_back(embree_builder(scene, RTC_BUILD_QUALITY_HIGH, false, "Embree high, fast"));
#endif
    std::erase_if(builders,
                  [&](const Builder& b) { return b.name.find(only) == std::string::npos; });
    std::vector<std::array<std::vector<double>, 2>> seconds(builders.size());
    std::vector<double> bytes(builders.size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < builders.size(); ++i) {
            for (const std::size_t many : {0, 1}) {
                const Built built = builders[i].build(many == 0 ? 1 : threads);
                seconds[i][many].push_back(built.seconds);
                bytes[i] = built.bytes;
            }
        }
    }
    std::string text;
    for (std::size_t i = 0; i < builders.size(); ++i) {
        text +=
            row(scene, builders[i], spread_of(seconds[i][0]), spread_of(seconds[i][1]), bytes[i]);
    }
    return text;
}

std::string head(int rounds, int threads) {
    return fmt::format(
        "{}, robust but where it says fast; medians of {} rounds in turn (least to greatest). "
        "Bytes are those of the "
        "tree and its leaves, without vertices and indices on either side. The cost is expected "
        "visits of a node, a leaf of up to {} triangles as {}; Embree's by its builder called "
        "through rtcBuildBVH.\n\n"
        "| scene | builder | s, 1 thread | s, {} threads | million triangles / s | bytes / "
        "triangle "
        "| cost |\n|---|---|---|---|---|---|---|\n",
        peer_version(), rounds, kBlockWidth, kBlockCost, threads);
}

}  // namespace

int main(int argc, char** argv) try {
    prepare_heap();  // as in the program: freed memory stays, for both sides
    const CommandLine line(argc, argv, {"--rounds", "--threads", "--only", "--markdown"});
    if (line.rest.empty()) {
        throw Error(ErrorKind::Usage, fmt::format("no scene; scenes are {}", kSceneSpecs));
    }
    const auto rounds = static_cast<int>(line.count("--rounds", 5));
    const auto threads = static_cast<int>(line.count("--threads", 2));
    const std::string only = line.text("--only", "");
    const std::string file = line.text("--markdown", "");
    std::string text = head(rounds, threads);
    fmt::print("{}", text);
    for (const std::string& spec : line.rest) {
        const std::string rows = run(make_scene(spec), rounds, threads, only);
        fmt::print("{}", rows);
        std::fflush(stdout);
        text += rows;
        if (!file.empty()) write_file_atomically(file, text);
    }
    return 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "build_table: {}\n", error.what());
    return 1;
}
