#include "alhazen/renderers/core/rounds.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/renderers/core/reports/sampling_report.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

using RoundClock = std::chrono::steady_clock;

/// Smallest number of samples after which a pixel may end.
constexpr std::uint32_t kLeastSamples = 16;
/// Pixel values below this count as this in the noise.
constexpr double kDark = 0.01;

/// Renders one film.
class RoundRender {
  public:
    RoundRender(const TiledRenderer& renderer, const RenderJob& job, Film& film,
                RoundClock::time_point begin)
        : renderer_(renderer),
          job_(job),
          plan_(*job.sampling),
          film_(film),
          filter_(plan_.shared ? *find_filter("box") : *plan_.filter,
                  plan_.shared ? 0.5 : plan_.radius),
          most_(static_cast<std::uint32_t>(job.samples_per_pixel)),
          begin_(begin) {
        report_.pixels = wanting_ = film.crop().area();
        if (plan_.sampler->progressive) sampler_ = plan_.sampler->make(job.seed, most_);
        if (plan_.shared) shared_.emplace(*plan_.filter, plan_.radius, film.crop());
        if (plan_.has_rounds()) sums_.resize(film.crop().area());
        if (plan_.noise) {
            wanted_.assign(film.crop().area(), 1);
            noise_.assign(film.crop().area(), std::numeric_limits<float>::infinity());
        }
    }

    RenderReport run() {
        RenderReport whole;
        while (true) {
            const RenderReport round = render_round();
            whole.counters += round.counters;
            whole.done = round.done;
            whole.parts = round.parts;
            whole.threads = round.threads;
            if (!round.complete() || is_done()) break;
        }
        report_.most_samples = samples_;
        report_.pixels_above = plan_.noise ? wanting_ : 0;
        whole.sampling = std::make_shared<SamplingReport>(report_);
        return whole;
    }

  private:
    /// Samples per pixel of the next round.
    [[nodiscard]] std::uint32_t next_count() const {
        if (!plan_.has_rounds()) return most_;
        std::uint32_t count = std::max(samples_, plan_.seconds ? 1u : kLeastSamples / 2);
        if (plan_.seconds && samples_ > 0) count = count_in_time();
        return std::min(count, most_ - samples_);
    }

    /// The largest power of two, up to the next doubling, that fits into the time limit.
    [[nodiscard]] std::uint32_t count_in_time() const {
        const std::uint32_t doubled = std::bit_ceil(samples_ + 1);
        std::uint32_t count = std::bit_floor(doubled - samples_);
        while (count > 1 && !has_time_for(count)) count /= 2;
        return count;
    }
    [[nodiscard]] bool has_time_for(std::uint32_t count) const {
        const double spent = std::chrono::duration<double>(RoundClock::now() - begin_).count();
        const double work = static_cast<double>(count) * static_cast<double>(wanting_);
        return spent + last_seconds_ * work / last_work_ <= *plan_.seconds;
    }

    RenderReport render_round() {
        const RoundClock::time_point begin = RoundClock::now();
        const std::uint32_t count = next_count();
        const bool first = samples_ == 0;
        std::uint64_t seed = job_.seed;
        if (!plan_.sampler->progressive) {
            if (!first) seed = mix64(job_.seed ^ mix64(samples_));
            sampler_ = plan_.sampler->make(seed, count);
        }
        std::atomic<std::uint64_t> finished = 0;
        const SampleRound round{*sampler_,
                                filter_,
                                plan_.sampler->progressive ? samples_ : 0,
                                count,
                                wanted_,
                                sums_,
                                seed,
                                shared_ ? &*shared_ : nullptr,
                                {},
                                &finished};
        RenderJob part = job_;
        part.round = &round;
        if (!first) part.aovs = nullptr;
        const RenderReport report =
            render_tiles(part, film_, [&] { return renderer_.begin(part); });
        if (shared_) shared_->write(film_);
        last_seconds_ = std::chrono::duration<double>(RoundClock::now() - begin).count();
        const std::uint64_t pixels = report.complete() ? wanting_ : finished.load();
        if (pixels > 0) {
            samples_ += count;
            report_.rounds.push_back({count, pixels, last_seconds_});
            report_.stopped = !report.complete();
        }
        if (!report.complete()) return report;
        last_work_ = static_cast<double>(count) * static_cast<double>(wanting_);
        if (plan_.noise) measure_noise();
        return report;
    }

    /// After a doubling and at the end: finds the noise of all pixels and those to continue.
    void measure_noise() {
        const bool doubled = std::has_single_bit(samples_);
        if (samples_ >= kLeastSamples && (doubled || samples_ == most_)) {
            find_noise();
            find_wanting();
        }
        if (!doubled || samples_ < kLeastSamples / 2) return;
        const std::uint64_t area = film_.crop().area();
        before_.assign(first_pixel(), first_pixel() + area);
        samples_before_ = samples_;
    }
    [[nodiscard]] const Rgb* first_pixel() const {
        return &film_.at(film_.crop().x0, film_.crop().y0);
    }

    /// Sets the noise of the pixels that were in the round.
    void find_noise() {
        // V is the mean of nA and nB samples, whose own means are A and B: the variance of V is
        // that of A - B times nA nB / n^2, and A - B is (A - V) n / nB.
        const double scale = std::sqrt(static_cast<double>(samples_before_) /
                                       static_cast<double>(samples_ - samples_before_));
        const double even = std::pow(static_cast<double>(samples_), plan_.sampler->error_exponent);
        for (std::size_t k = 0; k < noise_.size(); ++k) {
            if (wanted_[k] == 0) continue;
            const Rgb& now = first_pixel()[k];
            const Rgb change = now - before_[k];
            // For stratified samples the change is often 0 by symmetry; their variance is not.
            const double error = std::max(
                scale * Rgb{std::abs(change.r), std::abs(change.g), std::abs(change.b)}.max(),
                sums_[k].deviation() / even);
            noise_[k] = static_cast<float>(error / std::sqrt(std::max(now.max(), kDark)));
        }
    }

    /// Keeps the pixels whose noise, or that of one of the eight around them, is above the limit.
    void find_wanting() {
        const int width = film_.crop().width(), height = film_.crop().height();
        const auto at = [&](int x, int y) {
            return std::size_t(y) * std::size_t(width) + std::size_t(x);
        };
        const auto around = [&](int x, int y) {
            float largest = 0.0f;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
                    largest = std::max(largest, noise_[at(u, v)]);
                }
            }
            return largest;
        };
        wanting_ = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                std::uint8_t& wanted = wanted_[at(x, y)];
                if (wanted != 0 && !(around(x, y) > *plan_.noise)) wanted = 0;
                wanting_ += wanted;
            }
        }
    }

    [[nodiscard]] bool is_done() {
        if (samples_ >= most_ || wanting_ == 0) return true;
        if (!plan_.seconds) return false;
        report_.out_of_time = !has_time_for(next_count());
        return report_.out_of_time;
    }

    const TiledRenderer& renderer_;
    const RenderJob& job_;
    const SamplingPlan& plan_;
    Film& film_;
    FilterKernel filter_;
    std::uint32_t most_;  ///< samples of a pixel
    RoundClock::time_point begin_;
    std::unique_ptr<Sampler> sampler_;
    std::optional<SharedFilm> shared_;
    std::vector<SampleSum> sums_;       ///< [pixel]; only with several rounds
    std::vector<std::uint8_t> wanted_;  ///< [pixel]; only with a limit of the noise
    std::vector<float> noise_;          ///< [pixel]; only with a limit of the noise
    std::vector<Rgb> before_;           ///< the film at the last doubling
    std::uint32_t samples_before_ = 0;
    std::uint32_t samples_ = 0;  ///< so far, of each pixel that continues
    std::uint64_t wanting_ = 0;  ///< pixels that continue
    double last_seconds_ = 0, last_work_ = 0;
    SamplingReport report_;
};

}  // namespace

RenderJob with_plan(const RenderJob& job) {
    static const SamplingPlan usual;
    RenderJob planned = job;
    if (planned.sampling == nullptr) planned.sampling = &usual;
    return planned;
}

RenderReport render_in_rounds(const TiledRenderer& renderer, const RenderJob& job, Film& film,
                              std::chrono::steady_clock::time_point begin) {
    return RoundRender(renderer, job, film, begin).run();
}

}  // namespace alhazen
