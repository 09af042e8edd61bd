/// Patches traced exactly compared with an Embree mesh of them: memory, preparation, rays per
/// second.
/// Usage: alhazen_patch_bench FILE [--side N] [--rounds N] [--pixels X]
/// FILE contains patches (.bpt). The mesh is within X of a pixel (default 0.1) of them, for a
/// picture of side x side pixels (default 512) that they fill.

#include <fmt/format.h>

#include "alhazen/base/diagnostics.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/scene/scene.h"
#include "alhazen/session/conversion/tessellated.h"
#include "alhazen/session/load.h"
#include "alhazen/shapes/patches/patch_mesh.h"
#include "command_line.h"
#include "measure.h"
#include "our_tracer.h"
#ifdef ALHAZEN_HAVE_EMBREE
#include "embree/embree_packets.h"
#include "embree/embree_scene.h"
#endif

namespace {

using namespace alhazen;
using namespace alhazen::bench;

double seconds_of(const auto& work) {
    const Stopwatch time;
    work();
    return time.seconds();
}

/// The mesh of the triangles of a scene, with the view of its patches.
KernelScene scene_of(const SceneDescription& description) {
    KernelScene scene;
    for (const MeshDescription& mesh : description.meshes) {
        const auto first = static_cast<std::uint32_t>(scene.mesh.positions.size());
        for (const Vec3& p : mesh.mesh->positions) {
            scene.mesh.positions.push_back(
                {double(float(p.x)), double(float(p.y)), double(float(p.z))});
        }
        for (const auto& [a, b, c] : mesh.mesh->triangles) {
            scene.mesh.triangles.push_back({first + a, first + b, first + c});
        }
    }
    const Box3 box = scene.mesh.box();
    const double size = length(box.size());
    scene.look_at = box.center();
    scene.eye = box.center() + 1.4 * size * normalize(Vec3{0.35, -1.0, 0.45});
    scene.light = box.center() + size * Vec3{1.0, -1.5, 2.0};
    scene.ray_start = 1e-4 * size;
    return scene;
}

std::size_t patch_bytes(const SceneDescription& description, std::size_t& patches) {
    std::size_t bytes = 0;
    for (const ObjectDescription& object : description.objects) {
        for (const Part& part : object.parts) {
            const auto* shape = std::get_if<AnyShape>(&part.what);
            if (shape == nullptr || !std::holds_alternative<PatchMesh>(*shape)) continue;
            PatchMesh mesh = std::get<PatchMesh>(*shape);
            mesh.prepare();
            patches += mesh.patch_count();
            bytes += mesh.tree->bytes();
        }
    }
    return bytes;
}

void print_rates(const RaySet& set, const std::vector<Measured>& measured) {
    for (const Measured& m : measured) {
        const Spread s = m.spread();
        fmt::print("| {} | {} {} | {:.2f} | {:.2f} to {:.2f} | {} |\n", set.name, m.group, m.name,
                   s.median, s.lower, s.upper, m.hits);
    }
}

int run(int argc, char** argv) {
    const CommandLine line(argc, argv, {"--side", "--rounds", "--pixels"});
    if (line.rest.size() != 1) throw Error(ErrorKind::Usage, "name a file of patches");
    const int side = static_cast<int>(line.count("--side", 512));
    const int rounds = static_cast<int>(line.count("--rounds", 7));
    const double pixels = std::stod(line.text("--pixels", "0.1"));
    Diagnostics diagnostics;
    const SceneDescription exact = load_description(line.rest[0], {}, diagnostics);
    Scene scene;
    const double prepared = seconds_of([&] { scene = compile(exact); });
    std::size_t patches = 0;
    const std::size_t bytes = patch_bytes(exact, patches);

    SceneDescription meshed = exact;
    const double size = length(scene.aggregate->box().size());
    const double tolerance = pixels * size / side;
    const double divided = seconds_of([&] { (void)tessellate(meshed, tolerance); });
    const KernelScene kernel = scene_of(meshed);
    fmt::print("{} patches: {} bytes, {:.0f} a patch, prepared in {:.4f} s\n", patches, bytes,
               double(bytes) / double(patches), prepared);
    fmt::print("{} triangles within {:g}, made in {:.2f} s\n", kernel.mesh.triangles.size(),
               tolerance, divided);
    const auto triangles = build_ours(kernel);
    fmt::print("mesh, wide_bvh: {} bytes\n", triangles->memory_bytes());
#ifdef ALHAZEN_HAVE_EMBREE
    const EmbreeScene robust(kernel, {});
    const std::size_t embree = robust.memory_bytes() + kernel.mesh.positions.size() * 12 +
                               kernel.mesh.triangles.size() * 12;
    fmt::print(
        "mesh, Embree: {} bytes with its vertices, tree built in {:.2f} s; {:.0f} times the "
        "patches\n",
        embree, robust.build_seconds(), double(embree) / double(bytes));
#endif
    fmt::print("\n| rays | tracer | M rays/s | quartiles | hits |\n|---|---|---|---|---|\n");
    for (const RaySet& set : ray_sets(kernel, *scene.aggregate, side)) {
        OurTracer ours(*scene.aggregate, set), mesh(*triangles, set);
        std::vector<Contender> tracers{
            our_contender("patches", "single", [&](bool counts) { return ours.single(counts); }),
            our_contender("patches", "batch", [&](bool counts) { return ours.batches(counts); }),
            our_contender("mesh", "batch", [&](bool counts) { return mesh.batches(counts); })};
#ifdef ALHAZEN_HAVE_EMBREE
        const auto one = make_embree_packets(set, 1), eight = make_embree_packets(set, 8);
        for (const auto& [name, packets] : {std::pair{"mesh, rtcIntersect1", one.get()},
                                            std::pair{"mesh, rtcIntersect8", eight.get()}}) {
            tracers.push_back(
                {"Embree", name, [packets] { packets->reset(); },
                 [packets, &robust, &set] { packets->trace(robust.handle(), set.coherent); },
                 [packets] { return packets->count_hits(); }});
        }
#endif
        print_rates(set, measure(set.name, tracers, set.rays.size(), rounds));
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    }
}
