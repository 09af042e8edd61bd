#include "alhazen/renderers/photons/photon_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

using PassClock = std::chrono::steady_clock;

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

Wavelengths waves_of_pass(const RenderJob& job, std::uint32_t number) {
    if (!job.spectral) return {};
    constexpr double kGolden = 0.6180339887498949;
    constexpr std::uint64_t kWaves = 0x57617665;  // key, unique to this draw
    const double u = random_at(mix64(job.seed), kWaves, 0, 0) + kGolden * number;
    return Wavelengths::drawn(std::min(u - std::floor(u), 0x1.fffffffffffffp-1));
}

ShutterPart shutter_of_pass(const RenderJob& job, std::uint32_t number) {
    if (!job.scene.has_motion || number < 2) return {};
    constexpr std::uint64_t kShutter = 0x53687574;  // key, unique to this draw
    const int bits = std::bit_width(number) - 1;
    std::uint64_t part = mix64(mix64(job.seed) ^ kShutter) >> (64 - bits);
    for (int k = 0; k < bits; ++k) {
        part ^= std::uint64_t{(number >> k) & 1} << (bits - 1 - k);
    }
    const double length = std::ldexp(1.0, -bits);
    return {static_cast<double>(part) * length, length};
}

void refuse_stop_rules(const RenderJob& job, const char* renderer) {
    if (job.sampling == nullptr) return;
    refuse_shared_samples(*job.sampling, renderer);
    if (!job.sampling->has_rounds()) return;
    throw Error(ErrorKind::Usage,
                fmt::format("{} traces a fixed number of passes: it takes --spp, not --noise or "
                            "--time-limit",
                            renderer));
}

/// Reports the tiles of all passes as one task.
class PhotonPasses::Progress final : public ProgressSink {
  public:
    Progress(ProgressSink* sink, std::uint32_t passes) : sink_(sink), passes_(passes) {}
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

PhotonPasses::PhotonPasses(const RenderJob& job, Film& film, const char* renderer)
    : job_(with_plan(job)),
      film_(film),
      count_(static_cast<std::uint32_t>(job.samples_per_pixel)),
      progress_(std::make_unique<Progress>(job.control.progress, count_)),
      filter_(*job_.sampling->filter, job_.sampling->radius),
      sums_(film.crop().area()),
      sampling_(std::make_shared<SamplingReport>()) {
    refuse_stop_rules(job, renderer);
    job_.control.progress = progress_.get();
    sampler_ = job_.sampling->sampler->make(job.seed, count_);
    sampling_->pixels = film.crop().area();
    report_.sampling = sampling_;
}

PhotonPasses::~PhotonPasses() = default;

bool PhotonPasses::look(const Begin& begin) {
    const PassClock::time_point started = PassClock::now();
    const SampleRound round{
        *sampler_, filter_, done_, 1, {}, sums_, job_.seed, nullptr, shutter_of_pass(job_, done_)};
    RenderJob part = job_;
    part.round = &round;
    if (done_ > 0) part.aovs = nullptr;
    const RenderReport eye = render_tiles(part, film_, [&] { return begin(part); });
    report_.counters += eye.counters;
    report_.done = eye.done;
    report_.parts = eye.parts;
    report_.threads = eye.threads;
    if (!eye.complete()) return false;
    progress_->next_pass();
    sampling_->most_samples = ++done_;
    sampling_->rounds.push_back(
        {1, sampling_->pixels, std::chrono::duration<double>(PassClock::now() - started).count()});
    return true;
}

RenderReport& PhotonPasses::stopped() {
    report_.parts = std::max<std::size_t>(report_.parts, 1);
    report_.done = 0;
    return report_;
}

}  // namespace alhazen
