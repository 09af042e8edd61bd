/// Experiments B10 to B13 of claims.h: planes of any direction, classes of rays, light buffers,
/// lists from sphere to sphere.

#include <fmt/format.h>

#include "alhazen/laboratory/claim_run.h"
#include "alhazen/laboratory/claim_scenes.h"

namespace alhazen {
namespace {

constexpr auto kPrimitives = &TraversalStats::primitive_tests;
constexpr auto kBounds = &TraversalStats::box_tests;
constexpr auto kNodes = &TraversalStats::node_visits;

ReplayOptions counting(const ClaimRun& run) {
    return {.seconds = run.time_limit(), .repetitions = 0, .in_batches = false};
}

const KindFigures& of_kind(const ReplayFigures& figures, RayKind kind) {
    return figures.kinds[static_cast<std::size_t>(kind)];
}

double share_in_cache(const TraversalStats& tests) {
    return tests.cache_lookups == 0
               ? 0.0
               : static_cast<double>(tests.cache_hits) / static_cast<double>(tests.cache_lookups);
}

}  // namespace

void claim_b10(ClaimRun& run) {
    run.need_accelerator("bsp");
    for (const SpdScene& scene : kSpdScenes) {
        SceneTrial& trial = run.spd(scene);
        run.step(scene.name);
        const BuiltScene bsp = trial.build("bsp"), kd = trial.build("kd_tree");
        const ReplayFigures by_bsp = trial.ask(bsp.scene, counting(run));
        const ReplayFigures by_kd = trial.ask(kd.scene, counting(run));
        run.expect(fmt::format("{}: tests of primitives", scene.name),
                   fmt::format("{:.2f}", by_bsp.each(kPrimitives)),
                   fmt::format("{:.2f} k-d tree", by_kd.each(kPrimitives)),
                   by_bsp.each(kPrimitives) < by_kd.each(kPrimitives));
        run.tell("", fmt::format("{:.2f} nodes", by_bsp.each(kNodes)),
                 fmt::format("{:.2f}", by_kd.each(kNodes)));
        run.expect("", fmt::format("{:.2f} s to build", bsp.seconds),
                   fmt::format("{:.2f} s", kd.seconds), bsp.seconds > kd.seconds);
    }
}

void claim_b11(ClaimRun& run) {
    run.need_accelerator("ray_classification");
    for (const SpdScene& scene : kSpdScenes) {
        SceneTrial& trial = run.spd(scene);
        run.step(scene.name);
        const BuiltScene built = trial.build("ray_classification");
        const ReplayFigures classes = trial.ask(built.scene, counting(run));
        const ReplayFigures octree = trial.ask("octree", counting(run));
        run.expect(fmt::format("{}: tests of primitives", scene.name),
                   fmt::format("{:.2f}", classes.each(kPrimitives)),
                   fmt::format("{:.2f} octree", octree.each(kPrimitives)),
                   classes.each(kPrimitives) < octree.each(kPrimitives));
        const KindFigures& eye = of_kind(classes, RayKind::Eye);
        const double found = share_in_cache(eye.tests);
        run.expect("", fmt::format("{:.1f} % of eye rays in the cache", 100 * found), ">= 90 %",
                   found >= 0.9);
        run.tell("",
                 fmt::format("{:.1f} MB after these rays",
                             1e-6 * static_cast<double>(built.scene.aggregate->memory_bytes())));
    }
    run.note("Rays are asked in pieces of 64 neighbours, the pieces in an order by chance.");
}

void claim_b12(ClaimRun& run) {
    run.need_accelerator("light_buffer");
    for (const SpdScene& scene : kSpdScenes) {
        SceneTrial& trial = run.spd(scene);
        run.step(scene.name);
        const auto tests = [&](const char* accelerator) {
            const ReplayFigures figures = trial.ask(accelerator, counting(run));
            const KindFigures& shadow = of_kind(figures, RayKind::Shadow);
            return shadow.each(shadow.tests.*kPrimitives) + shadow.each(shadow.tests.*kBounds);
        };
        const double buffer = tests("light_buffer"), generic = tests("hierarchy");
        const double no_cache = tests("light_buffer:shadow_cache=off");
        run.expect(scene.name,
                   fmt::format("{:.2f} ({:.2f} without the last occluder)", buffer, no_cache),
                   fmt::format("{:.2f} hierarchy, {:.1f} times", generic, generic / buffer),
                   generic >= 4 * buffer);
    }
    run.note("Tests of primitives and bounds for each shadow ray.");
}

void claim_b13(ClaimRun& run) {
    run.need_accelerator("ray_coherence");
    double first = 0, last = 0;
    for (const std::uint64_t count : {125u, 1000u, 8000u}) {
        run.step(fmt::format("{} spheres", count));
        SceneTrial trial(claim_scene(ClaimShape::Spheres, count, 0.5), {.most_rays = 300'000});
        const ReplayFigures figures = trial.ask("ray_coherence", counting(run));
        const KindFigures& reflected = of_kind(figures, RayKind::Reflection);
        last = reflected.each(reflected.tests.*kPrimitives);
        if (first == 0) first = last;
        run.tell(fmt::format("{} spheres", count),
                 fmt::format("{:.2f} tests for each reflected ray, {:.2f} for each ray", last,
                             figures.each(kPrimitives)));
        run.expect("answers that differ from wide_bvh", fmt::format("{}", figures.disagreements),
                   "0", figures.disagreements == 0);
    }
    run.expect("8000 over 125 spheres, tests of reflected rays",
               fmt::format("{:.2f} times", last / first), "<= 2", last <= 2 * first);
}

}  // namespace alhazen
