#include "alhazen/laboratory/compare.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "alhazen/aggregates/accelerator_bytes.h"
#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/laboratory/cpu_clock.h"
#include "alhazen/laboratory/picture_check.h"
#include "alhazen/laboratory/tuning.h"

namespace alhazen {
namespace {

/// Time limit for the rays of one candidate in a search.
constexpr double kSampleSeconds = 0.3;

/// The accelerators, with `list` and `wide_bvh` first and each one once.
std::vector<std::string> with_references(const std::vector<std::string>& wanted) {
    std::vector<std::string> all{kDefaultAccelerator, "list"};
    for (const std::string& accelerator : wanted) {
        if (std::find(all.begin(), all.end(), accelerator) == all.end()) {
            all.push_back(accelerator);
        }
    }
    return all;
}

class Comparer {
  public:
    Comparer(SceneTrial& trial, const CompareOptions& options, const std::string& scene)
        : trial_(trial), options_(options), scene_(scene), pictures_(trial) {}

    void run(Comparison& comparison) {
        const std::vector<std::string> all = with_references(options_.accelerators);
        steps_ = 2 * all.size();
        for (const std::string& accelerator : all) {
            comparison.measurements.push_back(
                measure(accelerator, accelerator.find(':') == std::string::npos
                                         ? Measurement::Variant::Default
                                         : Measurement::Variant::Given));
            done();
            search(comparison, comparison.measurements.back());
            done();
        }
    }

  private:
    void done() {
        ++done_;
        if (options_.progress != nullptr) options_.progress->update(phase_, done_, steps_);
    }
    void check_stop() const {
        if (options_.stop != nullptr && options_.stop->requested()) {
            throw Error(ErrorKind::Render, "stopped");
        }
    }
    void begin(const std::string& what) {
        check_stop();
        if (options_.progress == nullptr) return;
        phase_ = scene_ + " " + what;
        options_.progress->update(phase_, done_, steps_);
    }

    Measurement measure(const std::string& accelerator, Measurement::Variant variant) {
        begin(accelerator);
        Measurement m;
        m.accelerator = accelerator;
        m.variant = variant;
        BuiltScene built;
        try {
            built = trial_.build(accelerator);
        } catch (const Error& error) {
            m.unavailable = error.what();
            return m;
        }
        m.build_seconds = built.seconds;
        m.figures = trial_.ask(built.scene, {.seconds = options_.time_limit,
                                             .in_batches = m.name() == kDefaultAccelerator});
        m.cost = pictures_.check(built.scene, m.figures, options_.time_limit, m.picture);
        // Measured last, to include structures that accelerators build while rays are traced.
        m.bytes = accelerator_bytes(*built.scene.aggregate);
        return m;
    }

    /// Adds the accelerator with the best settings found, unless they are the defaults.
    void search(Comparison& comparison, const Measurement& plain) {
        const std::string name = plain.name();
        if (!options_.tune || plain.variant != Measurement::Variant::Default ||
            !plain.unavailable.empty() || tuning_steps(name).empty()) {
            return;
        }
        begin(name + " (search)");
        const CpuClock clock;
        const TuningResult found = tune(
            name, [&](const std::string& tried) { return sample_cost(tried); },
            [&] {
                check_stop();
                return clock.seconds() < 2 * options_.time_limit;
            });
        if (found.accelerator == name) return;
        Measurement tuned = measure(found.accelerator, Measurement::Variant::Tuned);
        tuned.tried = found.tried;
        tuned.search_cut_short = found.cut_short;
        comparison.measurements.push_back(std::move(tuned));
    }
    double sample_cost(const std::string& accelerator) {
        try {
            const BuiltScene built = trial_.build(accelerator);
            return trial_
                .ask(built.scene,
                     {.seconds = kSampleSeconds, .repetitions = 2, .in_batches = false})
                .nanoseconds();
        } catch (const Error&) {
            return std::numeric_limits<double>::infinity();
        }
    }

    SceneTrial& trial_;
    const CompareOptions& options_;
    const std::string& scene_;
    PictureChecker pictures_;
    std::string phase_;
    std::size_t done_ = 0, steps_ = 0;
};

}  // namespace

std::string Measurement::settings() const {
    const std::size_t colon = accelerator.find(':');
    return colon == std::string::npos ? std::string() : accelerator.substr(colon + 1);
}

const Measurement* Comparison::find(std::string_view name) const {
    for (const Measurement& m : measurements) {
        if (m.accelerator == name && m.unavailable.empty()) return &m;
    }
    return nullptr;
}

bool Comparison::holds() const {
    return std::all_of(measurements.begin(), measurements.end(),
                       [](const Measurement& m) { return !m.unavailable.empty() || m.agrees(); });
}

std::vector<std::string> parse_accelerators(std::string_view list) {
    std::vector<std::string> accelerators;
    if (list == "all") {
        for (const AcceleratorEntry& entry : accelerator_table()) {
            accelerators.emplace_back(entry.name);
        }
        return accelerators;
    }
    while (true) {
        const std::size_t comma = list.find(',');
        const std::string piece(list.substr(0, comma));
        // Names have no equals sign: such a piece is a further setting.
        const std::size_t equals = piece.find('=');
        if (!accelerators.empty() && equals != std::string::npos && equals < piece.find(':')) {
            accelerators.back() += "," + piece;
        } else {
            accelerators.push_back(piece);
        }
        if (comma == std::string_view::npos) break;
        list.remove_prefix(comma + 1);
    }
    for (const std::string& accelerator : accelerators) check_accelerator(accelerator);
    return accelerators;
}

Comparison compare(SceneDescription description, const std::string& scene,
                   const CompareOptions& options) {
    if (options.progress != nullptr) options.progress->update(scene + " picture", 0, 1);
    SceneTrial trial(std::move(description), options.trial);
    if (options.progress != nullptr) options.progress->update(scene + " picture", 1, 1);
    Comparison comparison;
    comparison.scene = scene;
    const Film& film = trial.picture().film;
    comparison.width = film.crop().width();
    comparison.height = film.crop().height();
    comparison.census = trial.reference().census;
    comparison.rays = trial.picture().counters;
    comparison.recorded = trial.stream().by_kind();
    comparison.picture.assign(film.data(), film.data() + 3 * film.crop().area());
    comparison.encoding = trial.reference().conventions.film.encoding();
    Comparer(trial, options, scene).run(comparison);
    return comparison;
}

}  // namespace alhazen
