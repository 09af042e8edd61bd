#include "alhazen/renderers/vcm/pilot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "alhazen/renderers/bidirectional/bidirectional.h"
#include "alhazen/renderers/path_tracing/path_tracing.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr int kPilotPasses = 4;
constexpr double kPilotPixels = 3072;
/// The cost of a merged pair of vertices, in rays.
constexpr double kRaysOfMerge = 0.1;

double mean_of_channels(const Rgb& c) {
    return (c.r + c.g + c.b) / 3.0;
}

/// Statistics of the passes of one method.
struct PilotPictures {
    std::vector<double> mean, variance;  ///< [pixel] of one pass
    double cost = 0;                     ///< rays per pixel of a pass
    bool complete = true;
};

/// `render(job, film)` returns the cost of a pass.
PilotPictures pilot_pictures(const RenderJob& job, int width, int height,
                             const std::function<double(const RenderJob&, Film&)>& render) {
    RenderJob part = job;
    part.samples_per_pixel = 1;
    part.aovs = nullptr;
    part.photons = nullptr;
    part.control.progress = nullptr;
    PilotPictures pictures;
    const auto pixels = std::size_t(width) * std::size_t(height);
    std::vector<double> squares(pixels);
    pictures.mean.resize(pixels);
    pictures.variance.resize(pixels);
    for (int pass = 0; pass < kPilotPasses; ++pass) {
        part.seed = mix64(job.seed + static_cast<std::uint64_t>(pass) + 1);
        Film film(width, height, {0, 0, width, height});
        pictures.cost += render(part, film) / (kPilotPasses * static_cast<double>(pixels));
        for (std::size_t i = 0; i < pixels; ++i) {
            const double value = mean_of_channels(film.from(0, 0)[i]);
            pictures.mean[i] += value / kPilotPasses;
            squares[i] += value * value;
        }
    }
    for (std::size_t i = 0; i < pixels; ++i) {
        const double mean = pictures.mean[i];
        pictures.variance[i] =
            std::max(0.0, squares[i] - kPilotPasses * mean * mean) / (kPilotPasses - 1);
    }
    pictures.complete = !job.stop_requested();
    return pictures;
}

/// Relative squared errors, by the brightness of each pixel.
class RelativeNoise {
  public:
    explicit RelativeNoise(const PilotPictures& reference) : reference_(reference) {
        double sum = 0.0;
        for (const double value : reference.mean) sum += value;
        const double floor = 0.1 * sum / static_cast<double>(reference.mean.size());
        for (const double value : reference.mean) {
            const double scale = value * value + floor * floor;
            over_.push_back(scale > 0.0 ? 1.0 / (scale * double(reference.mean.size())) : 0.0);
        }
    }
    /// Variance of one pass.
    [[nodiscard]] double variance(const PilotPictures& pictures) const {
        double own = 0.0, off = 0.0, of_reference = 0.0;
        for (std::size_t i = 0; i < over_.size(); ++i) {
            const double difference = pictures.mean[i] - reference_.mean[i];
            own += over_[i] * pictures.variance[i];
            off += over_[i] * kPilotPasses * difference * difference;
            of_reference += over_[i] * reference_.variance[i];
        }
        return std::max(own, off - of_reference);
    }

  private:
    const PilotPictures& reference_;
    std::vector<double> over_;  ///< [pixel]
};

/// The ratio `of` / `other` in words.
std::string beside(double of, double other) {
    if (!(other > 0.0)) return "more than that";
    const double ratio = of / other;
    return ratio < 1.0 ? fmt::format("{:.2g} of that", ratio)
                       : fmt::format("{:.2g} times that", ratio);
}

double rays_of(const RenderReport& report) {
    return static_cast<double>(report.counters.total_cast());
}

}  // namespace

PilotFinding make_pilot_run(const RenderJob& job, const Film& film, const VcmSettings& settings) {
    const double frame = double(film.frame_width()) * film.frame_height();
    const double scale = std::min(0.25, std::sqrt(kPilotPixels / frame));
    const auto side = [&](int of) { return std::max(1, static_cast<int>(of * scale)); };
    const int width = side(film.frame_width()), height = side(film.frame_height());
    const double share = double(width) * height / frame;
    const auto run = [&](const std::function<double(const RenderJob&, Film&)>& render) {
        return pilot_pictures(job, width, height, render);
    };
    const PilotPictures merging = run([&](const RenderJob& part, Film& picture) {
        MergeWork work;
        const double rays = rays_of(render_merging(part, picture, settings, work));
        // All pixels of the frame share the light paths of a pass.
        const auto light_rays = static_cast<double>(work.light_rays);
        return rays - (1.0 - share) * light_rays + kRaysOfMerge * static_cast<double>(work.merged);
    });
    const PilotPictures joining = run([&](const RenderJob& part, Film& picture) {
        return rays_of(Bidirectional(settings.paths).render(part, picture));
    });
    const PilotPictures eye = run([&](const RenderJob& part, Film& picture) {
        return rays_of(PathTracing(settings.paths).render(part, picture));
    });
    PilotFinding finding;
    finding.complete = merging.complete && joining.complete && eye.complete;
    const RelativeNoise noise(merging);
    const auto work = [&](const PilotPictures& p) { return noise.variance(p) * p.cost; };
    const double merged = work(merging), joined = work(joining), by_eye = work(eye);
    finding.pays = merged < joined;
    finding.sentence = fmt::format(
        "vcm: a pilot run of {} passes at {} x {} pixels shows that merging {}: its variance times "
        "cost is {} of bidirectional, and {} of path_tracing",
        kPilotPasses, width, height, finding.pays ? "pays" : "does not pay", beside(merged, joined),
        beside(merged, by_eye));
    return finding;
}

}  // namespace alhazen
