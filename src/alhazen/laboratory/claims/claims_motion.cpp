/// Experiment F5 of claims.h: the cost of motion.

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "alhazen/laboratory/claims/claim_run.h"
#include "alhazen/laboratory/claims/sampled_pictures.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/distributed/distributed.h"
#include "alhazen/sampling/random.h"
#include "alhazen/scene_model/scene_motion.h"

namespace alhazen {
namespace {

/// Length of the motion relative to a ball's radius; the direction is random.
constexpr double kDistance = 0.2;

/// Gives every `nth` ball uniform motion while the shutter is open.
SceneDescription with_moving_balls(SceneDescription d, std::size_t nth) {
    RandomStream random(1984);
    std::size_t number = 0;
    for (ObjectDescription& object : d.objects) {
        for (Part& part : object.parts) {
            const AnyShape* shape = std::get_if<AnyShape>(&part.what);
            const Sphere* ball = shape == nullptr ? nullptr : std::get_if<Sphere>(shape);
            if (ball == nullptr || number++ % nth != 0) continue;
            const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi);
            const double across = std::sqrt(1 - z * z);
            const Vec3 way = kDistance * ball->radius *
                             Vec3{across * std::cos(turn), across * std::sin(turn), z};
            part.motion = std::make_shared<const PartMotion>(PartMotion{
                {}, {{0, Affine{}}, {1, Affine::translate(way)}}, part.object_from_part});
        }
    }
    open_shutter(d, {0, 1});
    return d;
}

/// Processor time and number of rays of a picture.
struct MotionCost {
    double seconds = kInfinity;
    std::uint64_t rays = 0;

    void measure(const Scene& scene) {
        static const SamplingPlan plan;
        const std::clock_t begin = std::clock();
        const SampledPicture picture = sampled(scene, Distributed(), 256, 16, {.sampling = &plan});
        seconds = std::min(seconds, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
        rays = picture.report.counters.total_cast();
    }
};

}  // namespace

void claim_f5(ClaimRun& run) {
    const SceneDescription balls = run.generated("balls", 4);
    const Scene still = compile(balls), some = compile(with_moving_balls(balls, 10)),
                all = compile(with_moving_balls(balls, 1));
    MotionCost still_cost, some_cost, all_cost;
    for (int pass = 1; pass <= 3; ++pass) {
        run.step(fmt::format("pass {}", pass));
        still_cost.measure(still);
        some_cost.measure(some);
        all_cost.measure(all);
    }
    const auto tell = [&](const char* what, const Scene& scene, const MotionCost& cost) {
        const double ratio = cost.seconds / still_cost.seconds;
        run.expect(
            fmt::format("{} of 7381 balls move: time over that of the still scene",
                        scene.census.moving_things),
            fmt::format("{:.2f} / {:.2f} s = {:.2f}", cost.seconds, still_cost.seconds, ratio),
            "<= 1.5", ratio <= 1.5);
        run.tell(fmt::format("{}: rays over those of the still scene", what),
                 fmt::format("{:.3f}", double(cost.rays) / double(still_cost.rays)));
    };
    tell("some", some, some_cost);
    tell("all", all, all_cost);
    run.note(
        "SPD balls of size 4, each ball by a fifth of its radius; 256 x 256 pixels, 16 samples, "
        "processor time of one thread, the least of three pictures in turn.");
}

}  // namespace alhazen
