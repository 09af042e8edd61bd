/// Experiments B14 and H1 of claims.h: instances of instances.

#include <fmt/format.h>

#include "alhazen/laboratory/claims/claim_run.h"

namespace alhazen {
namespace {

constexpr std::uint64_t kLarge = 2'000'000'000, kSmall = 2'000'000;
constexpr double kMegabyte = 1e6;

struct FieldFigures {
    SceneCensus census;
    double nanoseconds = 0;
    std::uint64_t rays = 0;

    [[nodiscard]] double bytes() const {
        return static_cast<double>(census.scene_bytes + census.accelerator_bytes);
    }
};

FieldFigures measure_field(ClaimRun& run, std::uint64_t size) {
    SceneTrial trial(run.generated("field", size), {.longest_side = 256, .most_rays = 500'000});
    const ReplayFigures f =
        trial.ask(trial.reference(), {.seconds = run.time_limit(), .repetitions = 3});
    return {trial.reference().census, f.nanoseconds(), trial.stream().rays.size()};
}

std::string megabytes(double bytes) {
    return fmt::format("{:.2f} MB", bytes / kMegabyte);
}

}  // namespace

void claim_b14(ClaimRun& run) {
    const FieldFigures small = measure_field(run, kSmall), large = measure_field(run, kLarge);
    run.expect("effective primitives", fmt::format("{}", large.census.effective_primitives),
               ">= 2 x 10^9", large.census.effective_primitives >= kLarge);
    run.expect("scene and structures", megabytes(large.bytes()), "<= 100 MB",
               large.bytes() <= 100 * kMegabyte);
    run.tell("the same with 10^3 fewer", megabytes(small.bytes()));
    const double ratio = large.nanoseconds / small.nanoseconds;
    run.expect(
        "time for each ray, over that with 10^3 fewer",
        fmt::format("{:.0f} / {:.0f} ns = {:.2f}", large.nanoseconds, small.nanoseconds, ratio),
        "<= 3", ratio <= 3);
    run.note(
        "The generated scene `field` by wide_bvh; memory of the whole process is larger, see "
        "docs/results.md.");
}

void claim_h1(ClaimRun& run) {
    const FieldFigures field = measure_field(run, kLarge);
    const double each = field.bytes() / static_cast<double>(field.census.effective_primitives);
    run.expect("bytes per effective primitive", fmt::format("{:.2e}", each), "<= 1e-2",
               each <= 1e-2);
    run.tell("scene and structures", fmt::format("{} for {} primitives", megabytes(field.bytes()),
                                                 field.census.effective_primitives));
}

}  // namespace alhazen
