/// Experiments F1 and F2 of claims.h: adaptive supersampling.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/laboratory/claims/claim_run.h"
#include "alhazen/laboratory/claims/sampled_pictures.h"
#include "alhazen/renderers/core/antialias_settings.h"
#include "alhazen/renderers/core/reports/antialias_report.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/renderers/whitted/whitted.h"

namespace alhazen {
namespace {

void compare_with_uniform(ClaimRun& run, const SpdScene& named) {
    constexpr int kSide = 64, kReferenceSamples = 4096;
    const Scene scene = compile(run.generated(named.name, named.size));
    const Whitted whitted;
    run.step(fmt::format("{}: {} samples per pixel", named.name, kReferenceSamples));
    const Film reference = sampled(scene, whitted, kSide, kReferenceSamples).film;
    const auto measured = [&](int samples, const AntialiasSettings* adaptive) {
        const SampledPicture p = sampled(scene, whitted, kSide, samples, {.antialias = adaptive});
        return RaysAndError{static_cast<double>(p.report.counters.total_cast()) / (kSide * kSide),
                            shown_rmse(p.film, reference)};
    };
    std::vector<RaysAndError> uniform;
    for (const int samples : {4, 16, 64, 256}) {
        run.step(fmt::format("{}: {} samples per pixel", named.name, samples));
        uniform.push_back(measured(samples, nullptr));
        run.tell(fmt::format("{}: uniform {}", named.name, samples),
                 fmt::format("{:.1f} rays per pixel, RMSE {:.5f}", uniform.back().rays,
                             uniform.back().error));
    }
    run.step(fmt::format("{}: adaptive", named.name));
    const auto adaptive = [&](const char* rule, const AntialiasSettings& settings, bool must_hold) {
        const RaysAndError ours = measured(1, &settings);
        const double ratio = rays_for(uniform, ours.error) / ours.rays;
        const std::string what =
            fmt::format("{}: {}threshold {}; rays of uniform over adaptive, equal error",
                        named.name, rule, settings.threshold);
        const std::string found = fmt::format("{:.2f} ({:.1f} rays per pixel, RMSE {:.5f})", ratio,
                                              ours.rays, ours.error);
        if (must_hold) {
            run.expect(what, found, ">= 2", ratio >= 2.0);
        } else {
            run.tell(what, found);
        }
    };
    const AntialiasSettings usual;  // the defaults
    adaptive("", usual, true);
    for (const double threshold : {0.05, 0.02, 0.01, 0.005}) {
        AntialiasSettings other = usual;
        other.guarantee = false;
        other.threshold = threshold;
        if (threshold < 0.01) other.depth = 5;
        adaptive("without the guarantee, ", other, false);
    }
    adaptive("by shades alone, ",
             {.threshold = 0.05, .guarantee = false, .weigh = false, .neighbours = false}, false);
}

// ---- F2

constexpr int kFilmSide = 96, kFrames = 64, kSphereRows = 11;
constexpr double kSpacing = 7.31, kSphereDiameter = 0.05;  ///< pixels
constexpr double kEyeDistance = 10.0;
constexpr double kFilmPixel = 2.0 * 2.5 / kFilmSide;  ///< size in the plane of the first layer

/// A lattice of two layers of bright spheres on black, and their positions in the picture.
struct LatticeFrame {
    Scene scene;
    std::vector<Vec2> places;  ///< positions, pixels
};

/// Moves the lattice about a twentieth of a pixel sideways, and less upwards, per frame.
LatticeFrame lattice_frame(int frame) {
    LatticeFrame result;
    SceneDescription d;
    d.objects.push_back({"root", {}, {}});
    Material bright;
    bright.emission.color = {1, 1, 1};
    d.materials.push_back({bright, {}});
    CameraDescription camera;
    camera.camera =
        look_along({0, 0, kEyeDistance}, {0, 0, -1}, {0, 1, 0}, 2.0 * std::atan(0.25), 1.0);
    d.cameras.push_back(camera);
    const double dx = 0.0571 * frame, dy = 0.0237 * frame;
    for (int layer = 0; layer < 2; ++layer) {
        const double scale = kFilmPixel * (1.0 + 0.02 * layer);  // of a pixel in this layer
        for (int k = 0; k < kSphereRows * kSphereRows; ++k) {
            const Vec2 p{8.0 + kSpacing * (k % kSphereRows + 0.5 * layer) + dx,
                         8.0 + kSpacing * (k / kSphereRows + 0.5 * layer) + dy};
            const Vec3 center{scale * (p.x - 0.5 * kFilmSide), scale * (0.5 * kFilmSide - p.y),
                              -0.02 * kEyeDistance * layer};
            Part part;
            part.what = AnyShape{Sphere{center, 0.5 * kSphereDiameter * scale}};
            d.objects[0].parts.push_back(std::move(part));
            result.places.push_back(p);
        }
    }
    result.scene = compile(d);
    return result;
}

/// The light of a sphere: the sum of nine pixels around its position.
double light_of(const Film& film, const Vec2& place) {
    double sum = 0;
    const int x0 = static_cast<int>(place.x), y0 = static_cast<int>(place.y);
    for (int y = y0 - 1; y <= y0 + 1; ++y) {
        for (int x = x0 - 1; x <= x0 + 1; ++x) sum += film.at(x, y).r;
    }
    return sum;
}

/// Statistics of the light of all spheres over the frames.
struct Twinkling {
    std::vector<double> sum, sum2;  ///< [sphere]
    int frames = 0;
    std::uint64_t seen = 0;  ///< number of spheres with any light, summed over all frames

    void add(const Film& film, std::span<const Vec2> places) {
        sum.resize(places.size());
        sum2.resize(places.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            const double light = light_of(film, places[i]);
            sum[i] += light;
            sum2[i] += light * light;
            seen += light > 0;
        }
        ++frames;
    }
    /// Mean over spheres and frames.
    [[nodiscard]] double mean() const {
        double total = 0;
        for (const double s : sum) total += s;
        return total / (static_cast<double>(sum.size()) * frames);
    }
    /// Variance over time, mean over the spheres.
    [[nodiscard]] double variance() const {
        double total = 0;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const double m = sum[i] / frames;
            total += sum2[i] / frames - m * m;
        }
        return total / static_cast<double>(sum.size());
    }
    [[nodiscard]] double relative_variance() const { return variance() / (mean() * mean()); }
};

}  // namespace

void claim_f1(ClaimRun& run) {
    for (const SpdScene& scene : {SpdScene{"balls", 3}, SpdScene{"gears", 2}, SpdScene{"rings", 3},
                                  SpdScene{"tetra", 5}, SpdScene{"teapot", 6}}) {
        compare_with_uniform(run, scene);
    }
    run.note(
        "Pictures of 64 x 64 pixels by whitted, against 4096 jittered samples per pixel; rays of "
        "all kinds are counted. What uniform sampling needs for an error is interpolated between "
        "its pictures of 4, 16, 64 and 256 samples, by a power law. Depth 4, with threshold 0.005 "
        "depth 5. By shades alone: guarantee, weigh and neighbours off.");
}

void claim_f2(ClaimRun& run) {
    const RayCasting renderer;
    const AntialiasSettings with{.threshold = 0.05, .depth = 5};
    AntialiasSettings without = with;
    without.guarantee = false;
    Twinkling guaranteed, unguaranteed, plain;
    std::uint64_t spheres = 0, met = 0, rays = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
        run.step(fmt::format("frame {}", frame));
        const LatticeFrame f = lattice_frame(frame);
        const SampledPicture p = sampled(f.scene, renderer, kFilmSide, 1, {.antialias = &with});
        spheres += f.places.size();
        met += p.report.antialias->met;
        rays += p.report.antialias->eye_rays();
        guaranteed.add(p.film, f.places);
        unguaranteed.add(sampled(f.scene, renderer, kFilmSide, 1, {.antialias = &without}).film,
                         f.places);
        plain.add(sampled(f.scene, renderer, kFilmSide, 1).film, f.places);
    }
    run.expect("spheres met, over all frames", fmt::format("{} of {}", met, spheres), "all",
               met == spheres);
    run.expect("spheres with light in the picture, with the guarantee",
               fmt::format("{}", guaranteed.seen), "all", guaranteed.seen == spheres);
    run.tell("without it", fmt::format("{}", unguaranteed.seen));
    run.tell("one ray per pixel", fmt::format("{}", plain.seen));
    run.tell("mean light of a sphere", fmt::format("{:.6f} of a pixel", guaranteed.mean()),
             fmt::format("its area: {:.6f}", kPi / 4 * kSphereDiameter * kSphereDiameter));
    const auto ratio = [&](const Twinkling& other) {
        return other.relative_variance() / guaranteed.relative_variance();
    };
    run.expect("variance over time, relative to the mean squared: without over with",
               fmt::format("{:.3g} / {:.3g} = {:.0f}", unguaranteed.relative_variance(),
                           guaranteed.relative_variance(), ratio(unguaranteed)),
               ">= 10", ratio(unguaranteed) >= 10);
    run.expect("one ray per pixel over with: variance over time",
               fmt::format("{:.3g} / {:.3g} = {:.0f}", plain.variance(), guaranteed.variance(),
                           plain.variance() / guaranteed.variance()),
               ">= 10", plain.variance() >= 10 * guaranteed.variance());
    run.tell("rays per pixel with the guarantee",
             fmt::format("{:.1f}", static_cast<double>(rays) / (kFrames * kFilmSide * kFilmSide)));
    run.note(
        fmt::format("{} frames of {} x {} pixels; {} spheres of {} pixels in two layers, "
                    "threshold 0.05, depth 5. The light of a sphere is that of nine pixels.",
                    kFrames, kFilmSide, kFilmSide, 2 * kSphereRows * kSphereRows, kSphereDiameter));
}

}  // namespace alhazen
