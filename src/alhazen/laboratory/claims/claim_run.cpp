#include "alhazen/laboratory/claims/claim_run.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/sampling/random.h"
#include "alhazen/session/generators/generate.h"

namespace alhazen {
namespace {

/// Sample size per set, out of millions of rays; the standard error of the means is a few tenths of
/// a percent.
constexpr std::size_t kRecordedRays = 300'000;

}  // namespace

SceneTrial& ClaimRun::spd(const SpdScene& scene) {
    std::unique_ptr<SceneTrial>& trial = trials_[scene.name];
    if (!trial) trial = trial_of(scene, kRecordedRays);
    return *trial;
}

std::unique_ptr<SceneTrial> ClaimRun::spd_with_all_rays(const SpdScene& scene) const {
    return trial_of(scene, std::numeric_limits<std::size_t>::max());
}

std::unique_ptr<SceneTrial> ClaimRun::trial_of(const SpdScene& scene, std::size_t most_rays) const {
    SceneDescription description = generated(scene.name, scene.size);
    step(std::string(scene.name) + ": the rays");
    TrialOptions options;
    options.spd = true;
    options.most_rays = most_rays;
    return std::make_unique<SceneTrial>(std::move(description), options);
}

SceneDescription ClaimRun::generated(const std::string& name, std::uint64_t size) const {
    bool known = false;
    for (const GeneratorEntry& entry : generators()) known = known || name == entry.name;
    if (!known) throw ClaimUnavailable("there is no generated scene " + name);
    step(fmt::format("{} {}", name, size));
    return generate(name, size);
}

void ClaimRun::need_accelerator(const std::string& accelerator) const {
    try {
        check_accelerator(accelerator);
    } catch (const Error& error) {
        throw ClaimUnavailable(error.what());
    }
}

void ClaimRun::expect(const std::string& what, const std::string& ours,
                      const std::string& reference, bool holds) {
    report_.findings.push_back({what, ours, reference, holds});
}

void ClaimRun::tell(const std::string& what, const std::string& ours,
                    const std::string& reference) {
    report_.findings.push_back({what, ours, reference, {}});
}

void ClaimRun::note(const std::string& text) {
    report_.note += (report_.note.empty() ? "" : " ") + text;
}

void ClaimRun::step(const std::string& what) const {
    if (options_.stop != nullptr && options_.stop->requested()) {
        throw Error(ErrorKind::Render, "stopped");
    }
    if (options_.progress != nullptr) {
        options_.progress->update(report_.id + " " + what, 0, 1);
        options_.progress->update(report_.id + " " + what, 1, 1);
    }
}

SphereBoxes::SphereBoxes(std::size_t count, std::uint64_t seed)
    : radius_(0.3 / std::cbrt(static_cast<double>(count))) {
    RandomStream random(seed);
    centers_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        centers_.push_back({x, y, z});
    }
}

double log_log_slope(std::span<const double> n, std::span<const double> value) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < n.size(); ++i) {
        const double x = std::log(n[i]), y = std::log(value[i]);
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const auto count = static_cast<double>(n.size());
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

}  // namespace alhazen
