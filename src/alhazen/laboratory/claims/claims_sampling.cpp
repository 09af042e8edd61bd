/// Experiments F3 and F4 of claims.h: samplers and rounds of samples.

#include <fmt/format.h>

#include <vector>

#include "alhazen/laboratory/claims/claim_run.h"
#include "alhazen/laboratory/claims/sampled_pictures.h"
#include "alhazen/renderers/core/reports/sampling_report.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {
namespace {

/// Samples of `sobol` for the reference, whose error is far below those compared.
constexpr int kReferenceSamples = 1024;

SamplingPlan plan_with(const char* sampler) {
    SamplingPlan plan;
    plan.sampler = find_sampler(sampler);
    return plan;
}

/// A few thin and small objects far apart, before a uniform background.
SceneDescription sparse_scene() {
    SceneDescription d;
    d.objects.push_back({"root", {}, {}});
    Material bright, dim;
    bright.emission.color = {0.9, 0.8, 0.6};
    dim.emission.color = {0.1, 0.15, 0.2};
    d.materials.push_back({bright, {}});
    d.materials.push_back({dim, {}});
    CameraDescription camera;
    camera.camera = look_along({0, 0, 10}, {0, 0, -1}, {0, 1, 0}, 0.5, 1.0);
    d.cameras.push_back(camera);
    const auto add = [&](AnyShape shape, std::uint32_t material) {
        Part part;
        part.what = std::move(shape);
        part.material = MaterialId{material};
        d.objects[0].parts.push_back(std::move(part));
    };
    add(Plane{.point = {0, 0, -1}, .normal = {0, 0, 1}}, 1);
    for (int k = 0; k < 7; ++k) {
        add(Sphere{{-2.0 + 0.67 * k, 1.3 - 0.31 * k, 0}, 0.05 + 0.01 * k}, 0);
    }
    add(Cylinder{.base = {-2, -1.7, 0}, .top = {1.4, 1.9, 0}, .radius = 0.012}, 0);
    return d;
}

}  // namespace

void claim_f3(ClaimRun& run) {
    constexpr int kSide = 64, kSamples = 64;
    const Whitted whitted;
    const SamplingPlan sobol = plan_with("sobol"), independent = plan_with("independent");
    for (const SpdScene& named :
         {SpdScene{"balls", 3}, SpdScene{"gears", 2}, SpdScene{"tetra", 5}}) {
        const Scene scene = compile(run.generated(named.name, named.size));
        run.step(fmt::format("{}: reference", named.name));
        // Another seed, so that the pictures share no samples with the reference.
        const Film reference =
            sampled(scene, whitted, kSide, kReferenceSamples, {.sampling = &sobol}, 77).film;
        const auto error = [&](const SamplingPlan& plan, int samples) {
            run.step(fmt::format("{}: {} samples", named.name, samples));
            return shown_rmse(sampled(scene, whitted, kSide, samples, {.sampling = &plan}).film,
                              reference);
        };
        const double full = error(independent, kSamples), half = error(sobol, kSamples / 2);
        run.tell(fmt::format("{}: sobol with {}, RMSE", named.name, kSamples),
                 fmt::format("{:.5f}", error(sobol, kSamples)));
        run.expect(fmt::format("{}: RMSE of sobol with {} and independent with {}", named.name,
                               kSamples / 2, kSamples),
                   fmt::format("{:.5f}, {:.5f}", half, full), "not larger", half <= full);
    }
    run.note(
        fmt::format("Pictures of {0} x {0} pixels by whitted: edges of shapes, shadows and "
                    "mirror images; reference: 1024 samples of sobol.",
                    kSide));
}

void claim_f4(ClaimRun& run) {
    constexpr int kSide = 256;
    const RayCasting renderer;
    const Scene scene = compile(sparse_scene());
    const SamplingPlan sobol = plan_with("sobol");
    run.step("reference");
    const Film reference =
        sampled(scene, renderer, kSide, kReferenceSamples, {.sampling = &sobol}, 77).film;
    const auto errors_of = [&](const SampledPicture& picture) {
        return shown_rmse(picture.film, reference);
    };
    std::vector<RaysAndError> uniform;
    for (const int samples : {4, 16, 64, 256}) {
        run.step(fmt::format("{} samples", samples));
        const SampledPicture p = sampled(scene, renderer, kSide, samples, {.sampling = &sobol});
        uniform.push_back({double(samples), errors_of(p)});
        run.tell(fmt::format("uniform {}: RMSE", samples),
                 fmt::format("{:.6f}", uniform.back().error));
    }
    for (const double noise : {0.05, 0.02, 0.01}) {
        SamplingPlan rounds = sobol;
        rounds.noise = noise;
        run.step(fmt::format("noise {}", noise));
        const SampledPicture p = sampled(scene, renderer, kSide, 4096, {.sampling = &rounds});
        const double mean =
            static_cast<double>(p.report.sampling->samples()) / (double(kSide) * kSide);
        const double error = errors_of(p), ratio = rays_for(uniform, error) / mean;
        run.expect(fmt::format("--noise {}: samples of uniform over adaptive, equal error", noise),
                   fmt::format("{:.2f} ({:.1f} per pixel, RMSE {:.6f})", ratio, mean, error),
                   ">= 1.5", ratio >= 1.5);
    }
    run.note(
        fmt::format("A picture of {0} x {0} pixels: seven small balls and a wire before an even "
                    "ground; uniform pictures are interpolated by a power law.",
                    kSide));
}

}  // namespace alhazen
