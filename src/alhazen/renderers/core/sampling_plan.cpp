#include "alhazen/renderers/core/sampling_plan.h"

#include <fmt/format.h>

#include "alhazen/base/error.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/renderers/core/renderer_settings.h"
#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {

namespace {

template <class Entry>
[[noreturn]] void refuse_name(const char* option, const std::string& name,
                              std::span<const Entry> known) {
    std::string names;
    for (const Entry& entry : known) names += (names.empty() ? "" : ", ") + std::string(entry.name);
    throw Error(ErrorKind::Usage,
                std::string(option) + " '" + name + "': unknown; known: " + names);
}

void read_sampler(const std::string& text, SamplingPlan& plan) {
    const RendererSettings given(text, "--sampler");
    plan.sampler = find_sampler(given.name());
    if (plan.sampler == nullptr) refuse_name("--sampler", given.name(), samplers());
    given.finish();
}

/// Throws for a radius or a filter with which the weights of shared samples may sum to nearly 0.
void check_shared(const SamplingPlan& plan, const std::string& filter) {
    if (plan.radius < SamplingPlan::kLeastShared || plan.radius > SamplingPlan::kLargestShared) {
        throw Error(ErrorKind::Usage,
                    "--filter " + filter + ": samples are shared by a radius from 0.5 to 4");
    }
    if (FilterKernel(*plan.filter, plan.radius).has_negative_lobes()) {
        throw Error(ErrorKind::Usage, "--filter " + filter +
                                          ": samples cannot be shared by a filter with negative "
                                          "lobes");
    }
}

void read_filter(const std::string& text, SamplingPlan& plan) {
    RendererSettings given(text, "--filter");
    plan.filter = find_filter(given.name());
    if (plan.filter == nullptr) refuse_name("--filter", given.name(), filters());
    plan.radius = given.number("radius", plan.filter->radius, SamplingPlan::kLeastRadius,
                               SamplingPlan::kLargestRadius);
    constexpr const char* kOffOn[] = {"off", "on"};
    plan.shared = given.choice("shared", 0, kOffOn) == 1;
    if (plan.shared) check_shared(plan, text);
    given.finish();
}

}  // namespace

void refuse_shared_samples(const SamplingPlan& plan, const char* renderer) {
    if (!plan.shared) return;
    throw Error(ErrorKind::Usage, std::string(renderer) +
                                      " cannot share samples between pixels: leave shared=on out");
}

SamplingPlan::SamplingPlan()
    : sampler(find_sampler("sobol")), filter(find_filter("box")), radius(filter->radius) {}

std::optional<SamplingPlan> parse_sampling(const SamplingTexts& texts) {
    if (texts.noise && !(*texts.noise > 0)) {
        throw Error(ErrorKind::Usage, fmt::format("the noise to work for is {}; expected a number "
                                                  "above 0",
                                                  *texts.noise));
    }
    if (texts.seconds && !(*texts.seconds >= 0)) {
        throw Error(
            ErrorKind::Usage,
            fmt::format("the time limit is {} seconds; expected a number from 0", *texts.seconds));
    }
    SamplingPlan plan;
    plan.noise = texts.noise;
    plan.seconds = texts.seconds;
    if (texts.sampler.empty() && texts.filter.empty() && !plan.has_rounds()) return {};
    if (!texts.sampler.empty()) read_sampler(texts.sampler, plan);
    if (!texts.filter.empty()) read_filter(texts.filter, plan);
    if (plan.shared && plan.noise) {
        // Pixels with more samples would outweigh their neighbours.
        throw Error(ErrorKind::Usage,
                    "--filter shared=on needs the same number of samples in every pixel: leave "
                    "--noise out");
    }
    if (plan.has_rounds() && plan.sampler == find_sampler("regular")) {
        throw Error(ErrorKind::Usage,
                    "--sampler regular has one set of samples only: --noise and --time-limit need "
                    "another sampler");
    }
    return plan;
}

}  // namespace alhazen
