/// Experiments B10 to B13 of claims.h: BSP planes of arbitrary direction, ray classification, light
/// buffers, ray coherence.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "alhazen/laboratory/claims/claim_run.h"
#include "alhazen/laboratory/claims/claim_scenes.h"

namespace alhazen {
namespace {

/// Time limit that is not reached.
constexpr double kSecondsForAll = 1e4;

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
        const BuiltScene kd = trial.build("kd_tree"), few = trial.build("bsp"),
                         any = trial.build("bsp:planes=polygons");
        const ReplayFigures by_kd = trial.ask(kd.scene, counting(run)),
                            by_few = trial.ask(few.scene, counting(run)),
                            by_any = trial.ask(any.scene, counting(run));
        const double least = std::min(by_few.each(kPrimitiveTests), by_any.each(kPrimitiveTests));
        run.expect(fmt::format("{}: tests of primitives", scene.name),
                   fmt::format("{:.3f} 13 directions, {:.3f} of polygons",
                               by_few.each(kPrimitiveTests), by_any.each(kPrimitiveTests)),
                   fmt::format("{:.3f} k-d tree", by_kd.each(kPrimitiveTests)),
                   least < by_kd.each(kPrimitiveTests));
        run.tell(
            "",
            fmt::format("{:.2f}, {:.2f} nodes", by_few.each(kNodeVisits), by_any.each(kNodeVisits)),
            fmt::format("{:.2f}", by_kd.each(kNodeVisits)));
        run.expect("", fmt::format("{:.2f}, {:.2f} s to build", few.seconds, any.seconds),
                   fmt::format("{:.2f} s", kd.seconds),
                   few.seconds > kd.seconds && any.seconds > kd.seconds);
    }
    run.note(
        "The restricted tree of Kammaje and Mora, and that of Ize, Wald and Parker, whose "
        "planes are the axis-aligned ones and those of flat polygons; the claim holds if one "
        "of them does fewer tests. All with default settings. For spheres only the first tree "
        "has additional planes to choose from.");
}

void claim_b11(ClaimRun& run) {
    run.need_accelerator("ray_classification");
    for (const SpdScene& scene : kSpdScenes) {
        const std::unique_ptr<SceneTrial> trial = run.spd_with_all_rays(scene);
        run.step(scene.name);
        const BuiltScene built = trial->build("ray_classification");
        const ReplayOptions in_order{.seconds = kSecondsForAll, .repetitions = 0, .in_order = true};
        const ReplayFigures classes = trial->ask(built.scene, in_order);
        const ReplayFigures octree = trial->ask("octree", in_order);
        run.expect(fmt::format("{}: tests of primitives", scene.name),
                   fmt::format("{:.2f}", classes.each(kPrimitiveTests)),
                   fmt::format("{:.2f} octree", octree.each(kPrimitiveTests)),
                   classes.each(kPrimitiveTests) < octree.each(kPrimitiveTests));
        const KindFigures& eye = of_kind(classes, RayKind::Eye);
        const double found = share_in_cache(eye.tests);
        run.expect("", fmt::format("{:.1f} % of eye rays in the cache", 100 * found), ">= 90 %",
                   found >= 0.9);
        run.tell("",
                 fmt::format("{:.1f} MB after these rays",
                             1e-6 * static_cast<double>(built.scene.aggregate->memory_bytes())));
    }
    run.note(
        "All rays of the image, in its order. Fewer candidates and more cache hits exclude "
        "each other: a class small enough for few candidates contains few rays, so that the "
        "next ray is outside it. Only tests are counted; a ray visits about 3 nodes here, 20 "
        "to 40 in an octree.");
}

void claim_b12(ClaimRun& run) {
    run.need_accelerator("light_buffer");
    for (const SpdScene& scene : kSpdScenes) {
        SceneTrial& trial = run.spd(scene);
        run.step(scene.name);
        const auto tests = [&](const char* accelerator) {
            const ReplayFigures figures = trial.ask(accelerator, counting(run));
            const KindFigures& shadow = of_kind(figures, RayKind::Shadow);
            return shadow.each(shadow.tests.*kPrimitiveTests) +
                   shadow.each(shadow.tests.*kBoxTests);
        };
        const double buffer = tests("light_buffer"), generic = tests("hierarchy");
        const double no_cache = tests("light_buffer:shadow_cache=off");
        run.expect(scene.name,
                   fmt::format("{:.2f} ({:.2f} without the last occluder)", buffer, no_cache),
                   fmt::format("{:.2f} hierarchy, {:.1f} times", generic, generic / buffer),
                   generic >= 4 * buffer);
    }
    run.note("Tests of primitives and bounds per shadow ray.");
}

void claim_b13(ClaimRun& run) {
    run.need_accelerator("ray_coherence");
    for (const bool sparser : {true, false}) {
        double first = 0, last = 0;
        for (const std::uint64_t count : {125u, 1000u, 8000u}) {
            run.step(fmt::format("{} spheres", count));
            // Radii of n^(-1/2) keep the share of the view that spheres cover constant; radii of
            // n^(-1/3) keep their share of the volume and cover a growing share of the view.
            const double spread = 0.5 * (sparser ? std::pow(1e-3 * double(count), -1.0 / 6) : 1.0);
            SceneTrial trial(claim_scene(ClaimShape::Spheres, count, spread),
                             {.most_rays = 300'000});
            const ReplayFigures figures = trial.ask("ray_coherence", counting(run));
            const KindFigures& reflected = of_kind(figures, RayKind::Reflection);
            last = reflected.each(reflected.tests.*kPrimitiveTests);
            if (first == 0) first = last;
            run.tell(fmt::format("{} spheres, {}", count, sparser ? "sparser" : "as dense"),
                     fmt::format("{:.2f} tests for each reflected ray, {:.2f} for each ray", last,
                                 figures.each(kPrimitiveTests)));
            run.expect("answers that differ from wide_bvh",
                       fmt::format("{}", figures.disagreements), "0", figures.disagreements == 0);
        }
        run.expect(fmt::format("8000 over 125 spheres, {}, tests of reflected rays",
                               sparser ? "sparser" : "as dense"),
                   fmt::format("{:.2f} times", last / first), "<= 2", last <= 2 * first);
    }
    run.note(
        "A direction cell has as many candidates as spheres visible in it. With radii "
        "proportional to n^(-1/2) and two direction cells per sphere their number does not "
        "depend on n. With radii of n^(-1/3) the share of the volume is constant, and the "
        "spheres fill the view.");
}

}  // namespace alhazen
