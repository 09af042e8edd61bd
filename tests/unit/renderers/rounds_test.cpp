// Samplers and filters by name, and rounds of samples.

#include "alhazen/renderers/core/rounds.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/renderers/core/reports/sampling_report.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/sampling/samplers/sampler.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::glowing;
using testing::SceneMaker;

constexpr int kWidth = 40, kHeight = 30;

struct SampledPicture {
    Film film{kWidth, kHeight, {0, 0, kWidth, kHeight}};
    RenderReport report;
};

SampledPicture picture(const Scene& scene, const SamplingPlan& plan, int samples, int threads = 2,
                       int tile_size = 8) {
    SampledPicture result;
    RenderJob job{.scene = scene,
                  .camera = scene.cameras[0].camera,
                  .samples_per_pixel = samples,
                  .seed = 7,
                  .sampling = &plan};
    job.control.threads = threads;
    job.control.tile_size = tile_size;
    result.report = Whitted{}.render(job, result.film);
    EXPECT_TRUE(result.report.complete());
    return result;
}

SamplingPlan plan_of(const std::string& sampler, const std::string& filter = "",
                     std::optional<double> noise = {}) {
    return *parse_sampling({.sampler = sampler, .filter = filter, .noise = noise, .seconds = {}});
}

/// A glowing ball before black; its edges are all that needs samples.
Scene ball() {
    SceneMaker maker;
    maker.add(Sphere{.radius = 0.7}, maker.material(glowing({1, 0.5, 0.25})));
    return maker.compile("wide_bvh");
}

void expect_same_pixels(const Film& a, const Film& b) {
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) EXPECT_EQ(a.at(x, y), b.at(x, y)) << x << " " << y;
    }
}

TEST(Rounds, EveryFilterKeepsAnEvenPicture) {
    SceneMaker maker;
    maker.add(Rectangle{{-9, -9, 0}, {18, 0, 0}, {0, 18, 0}},
              maker.material(glowing({0.25, 0.5, 1})));
    const Scene scene = maker.compile();
    for (const FilterEntry& filter : filters()) {
        const SampledPicture result = picture(scene, plan_of("jittered", filter.name), 8);
        for (int x = 0; x < kWidth; ++x) {
            EXPECT_EQ(result.film.at(x, 11), (Rgb{0.25, 0.5, 1})) << filter.name;
        }
    }
}

TEST(Rounds, PicturesAreTheSameForAnyThreadsAndTiles) {
    const Scene scene = ball();
    for (const SamplerEntry& sampler : samplers()) {
        if (std::string(sampler.name) == "regular") continue;
        const SamplingPlan plan = plan_of(sampler.name, "mitchell", 0.05);
        const SampledPicture one = picture(scene, plan, 128, 1, 32);
        const SampledPicture four = picture(scene, plan, 128, 4, 7);
        SCOPED_TRACE(sampler.name);
        expect_same_pixels(one.film, four.film);
        EXPECT_EQ(one.report.sampling->samples(), four.report.sampling->samples());
        EXPECT_EQ(one.report.counters[RayKind::Eye].cast, four.report.counters[RayKind::Eye].cast);
    }
}

TEST(Rounds, SharedSamplesGiveThePictureOfTheFilter) {
    const Scene scene = ball();
    for (const char* filter : {"tent", "gaussian:radius=1.5", "blackman_harris"}) {
        const std::string text = filter;
        const std::string more = text.find(':') == std::string::npos ? ":" : ",";
        const SampledPicture own = picture(scene, plan_of("sobol", text), 1024);
        const SampledPicture shared =
            picture(scene, plan_of("sobol", text + more + "shared=on"), 1024);
        // Pixels at the border of the picture know one side only.
        double squares = 0;
        for (int y = 4; y < kHeight - 4; ++y) {
            for (int x = 4; x < kWidth - 4; ++x) {
                const double d = own.film.at(x, y).r - shared.film.at(x, y).r;
                squares += d * d;
            }
        }
        // What is left is the noise of samples drawn by the filter.
        EXPECT_LT(std::sqrt(squares / ((kWidth - 8) * (kHeight - 8))), 1.5e-3) << filter;
    }
}

TEST(Rounds, SharedSamplesGiveTheSameBitsForAnyThreadsAndTiles) {
    const Scene scene = ball();
    const SamplingPlan plan = plan_of("sobol", "blackman_harris:radius=1.5,shared=on");
    const SampledPicture one = picture(scene, plan, 9, 1, 32);
    const SampledPicture four = picture(scene, plan, 9, 4, 7);
    expect_same_pixels(one.film, four.film);
}

TEST(Rounds, SharedSamplesAreRefusedWhereWeightsMayBeUneven) {
    EXPECT_THROW(static_cast<void>(plan_of("sobol", "tent:shared=on", 0.1)), Error);
    EXPECT_THROW(static_cast<void>(plan_of("sobol", "tent:shared=maybe")), Error);
    EXPECT_THROW(static_cast<void>(plan_of("sobol", "tent:shared=on,radius=5")), Error);
    EXPECT_THROW(static_cast<void>(plan_of("sobol", "tent:shared=on,radius=0.4")), Error);
    EXPECT_THROW(static_cast<void>(plan_of("sobol", "mitchell:shared=on")), Error);
    EXPECT_TRUE(plan_of("sobol", "tent:shared=on").shared);
}

TEST(Rounds, SeveralRoundsAddUpToOneWhereTheSamplerIsProgressive) {
    const Scene scene = ball();
    for (const char* sampler : {"sobol", "halton", "blue_noise", "independent"}) {
        SamplingPlan rounds = plan_of(sampler, "", 1e-6);
        const SampledPicture several = picture(scene, rounds, 64);
        const SampledPicture one = picture(scene, plan_of(sampler), 64);
        EXPECT_GT(several.report.sampling->rounds.size(), 2U);
        int same = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const Rgb d = several.film.at(x, y) + -1.0 * one.film.at(x, y);
                // Pixels all whose first samples agree end early; what they miss is small.
                EXPECT_LT(std::abs(d.r), 0.1) << sampler << " " << x << " " << y;
                same += std::abs(d.r) < 1e-12;
            }
        }
        EXPECT_GT(same, kWidth * kHeight - 5) << sampler;
    }
}

TEST(Rounds, PixelsWithoutNoiseGetFewSamplesAndTheOthersReachTheLimit) {
    const Scene scene = ball();
    constexpr double kNoise = 0.02;
    const SampledPicture result = picture(scene, plan_of("independent", "", kNoise), 1 << 14);
    const SamplingReport& report = *result.report.sampling;
    EXPECT_EQ(report.rounds.front().pixels, std::uint64_t{kWidth * kHeight});
    EXPECT_LT(report.rounds.back().pixels, std::uint64_t{kWidth * kHeight / 4});
    EXPECT_EQ(report.pixels_above, 0U);
    EXPECT_EQ(report.samples(), result.report.counters[RayKind::Eye].cast);
    // The requested standard error, of values near 0.5, and the error of its estimate.
    const SampledPicture reference = picture(scene, plan_of("sobol"), 4096);
    double squares = 0, at_edges = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double a = result.film.at(x, y).r, b = reference.film.at(x, y).r;
            if (b == 0.0 || b == 1.0) {
                EXPECT_EQ(a, b);
            }
            at_edges += b != 0.0 && b != 1.0;
            squares += (a - b) * (a - b) / std::max(b, 0.01);
        }
    }
    ASSERT_GT(at_edges, 50);
    EXPECT_LT(std::sqrt(squares / at_edges), 1.3 * kNoise);
}

/// Stops the work after a number of tiles.
class StopAfterTiles final : public ProgressSink {
  public:
    explicit StopAfterTiles(std::size_t tiles) : tiles_(tiles) {}
    void update(std::string_view, std::size_t, std::size_t) override {
        if (++done_ == tiles_) stop.request();
    }
    StopFlag stop;

  private:
    std::size_t tiles_, done_ = 0;
};

TEST(Rounds, AStoppedRoundCountsWhatItTook) {
    const Scene scene = ball();
    constexpr int kTile = 10;
    constexpr std::size_t kTiles = kWidth * kHeight / (kTile * kTile);
    for (const bool noise : {false, true}) {
        // In the first round, and in the second.
        for (const std::size_t tiles : {std::size_t{3}, kTiles + 2}) {
            if (!noise && tiles > kTiles) continue;
            const SamplingPlan plan =
                plan_of("sobol", "", noise ? std::optional(1e-9) : std::nullopt);
            StopAfterTiles sink(tiles);
            const RenderJob job{
                .scene = scene,
                .camera = scene.cameras[0].camera,
                .samples_per_pixel = 64,
                .sampling = &plan,
                .control = {
                    .threads = 1, .tile_size = kTile, .stop = &sink.stop, .progress = &sink}};
            Film film(kWidth, kHeight, {0, 0, kWidth, kHeight});
            const RenderReport report = Whitted{}.render(job, film);
            ASSERT_FALSE(report.complete());
            const SamplingReport& sampling = *report.sampling;
            EXPECT_EQ(sampling.samples(), report.counters[RayKind::Eye].cast) << tiles;
            EXPECT_EQ(sampling.rounds.size(), tiles > kTiles ? 2U : 1U);
            EXPECT_TRUE(sampling.stopped);
            EXPECT_EQ(sampling.finished_rounds(), sampling.rounds.size() - 1);
            EXPECT_EQ(sampling.rounds.back().pixels, (tiles % kTiles) * kTile * kTile);
            EXPECT_EQ(sampling.most_samples, !noise ? 64U : tiles > kTiles ? 16U : 8U);
        }
    }
}

TEST(Rounds, NoRoundBeginsThatWouldEndTooLate) {
    const Scene scene = ball();
    SamplingPlan plan = plan_of("sobol");
    plan.seconds = 0.2;
    const SampledPicture result = picture(scene, plan, SamplingPlan::kMostByRule);
    const SamplingReport& report = *result.report.sampling;
    double seconds = 0;
    for (const SamplingReport::Round& round : report.rounds) seconds += round.seconds;
    EXPECT_TRUE(report.out_of_time || report.most_samples == SamplingPlan::kMostByRule);
    EXPECT_LT(seconds, 0.6);
    EXPECT_GT(report.most_samples, 4U);
}

TEST(Rounds, TheLimitOfTimeHoldsForPhotonMapsToo) {
    SceneMaker maker;
    Material shining = glowing({0.5, 0.5, 0.5});
    shining.diffuse.color = {0.5, 0.5, 0.5};
    maker.add(Sphere{.radius = 9}, maker.material(shining));
    const Scene scene = maker.compile("wide_bvh");
    SamplingPlan plan = plan_of("sobol");
    plan.seconds = 0.01;
    Film film(1, 1, {0, 0, 1, 1});
    const RenderJob job{.scene = scene,
                        .camera = scene.cameras[0].camera,
                        .samples_per_pixel = SamplingPlan::kMostByRule,
                        .sampling = &plan,
                        .control = {.threads = 1}};
    const auto begin = std::chrono::steady_clock::now();
    const RenderReport report =
        make_renderer("photon_mapping:photons=100000,caustics=0")->render(job, film);
    const double whole =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const std::vector<SamplingReport::Round>& rounds = report.sampling->rounds;
    ASSERT_GT(whole - rounds[0].seconds, 2 * *plan.seconds);  // of the maps
    EXPECT_EQ(rounds.size(), 1U);
    EXPECT_TRUE(report.sampling->out_of_time);
}

TEST(SamplingPlan, BadTextsAreRefusedByName) {
    const auto message = [](const SamplingTexts& texts) -> std::string {
        try {
            (void)parse_sampling(texts);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Usage);
            return error.what();
        }
        return "";
    };
    const auto says = [&](const SamplingTexts& texts, const std::string& part) {
        EXPECT_NE(message(texts).find(part), std::string::npos) << message(texts);
    };
    says({.sampler = "soboll", .filter = "", .noise = {}, .seconds = {}}, "multi_jittered");
    says({.sampler = "sobol:x=1", .filter = "", .noise = {}, .seconds = {}}, "--sampler");
    says({.sampler = "", .filter = "bos", .noise = {}, .seconds = {}}, "blackman_harris");
    says({.sampler = "", .filter = "tent:radius=0", .noise = {}, .seconds = {}}, "radius");
    says({.sampler = "", .filter = "tent:width=1", .noise = {}, .seconds = {}}, "width");
    says({.sampler = "regular", .filter = "", .noise = 0.1, .seconds = {}}, "regular");
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    for (const double noise : {kNaN, -1.0, 0.0}) {
        says({.sampler = "", .filter = "", .noise = noise, .seconds = {}}, "the noise to work for");
    }
    for (const double seconds : {kNaN, -1.0}) {
        says({.sampler = "", .filter = "", .noise = {}, .seconds = seconds}, "the time limit");
    }
    EXPECT_FALSE(parse_sampling({}).has_value());
    EXPECT_EQ(parse_sampling({.sampler = "", .filter = "tent:radius=2", .noise = {}, .seconds = {}})
                  ->radius,
              2.0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
