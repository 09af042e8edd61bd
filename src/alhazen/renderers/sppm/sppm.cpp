#include "alhazen/renderers/sppm/sppm.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/renderers/core/sampling_report.h"
#include "alhazen/renderers/photons/photon_density.h"
#include "alhazen/renderers/photons/photon_eye.h"
#include "alhazen/renderers/photons/photon_grid.h"
#include "alhazen/renderers/photons/photon_records.h"
#include "alhazen/renderers/photons/photon_shooting.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

using PassClock = std::chrono::steady_clock;

constexpr std::size_t kEyePathsAtOnce = 256;

/// The eye of one pass.
class PassEye final : public PhotonEye {
  public:
    PassEye(const RenderJob& job, std::size_t, RayCounters& counters, const Illumination& lights,
            const PathSettings& paths, const PhotonGrid& grid)
        : PhotonEye(job, counters, lights, paths, kColorChannels), grid_(grid) {}

  private:
    [[nodiscard]] Spectrum photon_light(const SeenPoint& at) override {
        const PhotonFits fits(at.scatter);
        Spectrum sum;
        grid_.for_near(at.surface.point, [&](const Photon& photon) {
            if (fits(photon)) sum += scattered_light(at.scatter, photon, LightPart::NotGlossy);
        });
        return (1.0 / (kPi * grid_.radius() * grid_.radius())) * sum;
    }

    const PhotonGrid& grid_;
};

/// Reports the tiles of all passes as one work.
class PassProgress final : public ProgressSink {
  public:
    PassProgress(ProgressSink* sink, std::uint32_t passes) : sink_(sink), passes_(passes) {}
    void update(std::string_view phase, std::size_t done, std::size_t total) override {
        if (sink_ != nullptr && phase == "render") {
            sink_->update(phase, pass_ * total + done, passes_ * total);
        }
    }
    void next_pass() { ++pass_; }

  private:
    ProgressSink* sink_;
    std::size_t passes_, pass_ = 0;
};

/// Three times the median width of a pixel at what the eye sees.
double radius_of_pixels(const RenderJob& job, const Film& film) {
    constexpr int kProbes = 16;
    const RayCone cone = eye_cone(job.camera, film.frame_height(), 1);
    std::vector<double> widths;
    VisibleHit seen;
    for (int i = 0; i < kProbes * kProbes; ++i) {
        const Ray ray =
            eye_ray(job.camera, (i % kProbes + 0.5) / kProbes, (i / kProbes + 0.5) / kProbes);
        if (first_visible_hit(job.scene, ray, {}, false, nullptr, seen)) {
            widths.push_back(cone.width_at(seen.t));
        }
    }
    if (widths.empty()) return 1.0;
    const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), middle, widths.end());
    return 3.0 * *middle;
}

void record_photons_of(const PhotonGrid& grid, const RenderJob& job, const Film& film) {
    record_photon_layer(job, film, [&](const Vec3& point, const Vec3& normal) {
        const PhotonFits fits(normal, false);
        double count = 0.0;
        grid.for_near(point, [&](const Photon& photon) { count += fits(photon) ? 1.0 : 0.0; });
        return count / (kPi * grid.radius() * grid.radius());
    });
}

}  // namespace

RenderReport Sppm::render(const RenderJob& job, Film& film) const {
    RenderJob planned = with_plan(job);
    const SamplingPlan& plan = *planned.sampling;
    if (plan.has_rounds()) {
        throw Error(ErrorKind::Usage,
                    "sppm traces a fixed number of passes: it takes --spp, not --noise or a limit "
                    "of --time");
    }
    const Illumination lights(job.scene);
    const auto passes = static_cast<std::uint32_t>(job.samples_per_pixel);
    PassProgress progress(job.control.progress, passes);
    planned.control.progress = &progress;
    const std::unique_ptr<Sampler> sampler = plan.sampler->make(job.seed, passes);
    const FilterKernel filter(*plan.filter, plan.radius);
    std::vector<SampleSum> sums(film.crop().area());
    double radius = settings_.radius > 0.0 ? settings_.radius : radius_of_pixels(job, film);
    PhotonShot shot{settings_.photons,
                    {PhotonKind::Caustic, PhotonKind::Indirect},
                    settings_.paths.depth,
                    mix64(job.seed)};
    const auto most = static_cast<std::size_t>(
        std::min(settings_.memory * 1e6 / PhotonGrid::kBytesOfPhoton, 0x1p31));
    RenderReport report;
    note_silent_lights(lights, "sppm", report);
    auto sampling = std::make_shared<SamplingReport>();
    sampling->pixels = film.crop().area();
    report.sampling = sampling;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const PassClock::time_point begin = PassClock::now();
        ShotPhotons photons;
        if (lights.shines()) photons = shoot_photons(planned, lights, shot, most, "sppm");
        report.counters += photons.counters;
        if (!photons.complete) {
            report.parts = passes;
            report.done = pass;
            return report;
        }
        if (pass == 0) add_to_cloud(photons.photons, false, job.photons);
        const PhotonGrid grid(std::move(photons.photons), radius);
        if (pass == 0) record_photons_of(grid, job, film);
        const SampleRound round{*sampler, filter, pass, 1, {}, sums, job.seed};
        RenderJob part = planned;
        part.round = &round;
        if (pass > 0) part.aovs = nullptr;
        const RenderReport eye = render_tiles(part, film, [&] {
            return std::make_unique<RoundRenderer<PassEye>>(part, kEyePathsAtOnce, lights,
                                                            settings_.paths, grid);
        });
        report.counters += eye.counters;
        report.done = eye.done;
        report.parts = eye.parts;
        report.threads = eye.threads;
        if (!eye.complete()) return report;
        progress.next_pass();
        sampling->most_samples = pass + 1;
        sampling->rounds.push_back(
            {1, sampling->pixels, std::chrono::duration<double>(PassClock::now() - begin).count()});
        shot.seed = mix64(shot.seed);
        radius *= std::sqrt(squared_radius_step(settings_.alpha, static_cast<int>(pass) + 1));
    }
    return report;
}

}  // namespace alhazen
