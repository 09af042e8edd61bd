#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/image/image_difference.h"
#include "alhazen/session/scene_files.h"
#include "commands.h"
#include "messages.h"
#include "options.h"

namespace alhazen::cli {

namespace {

/// Room for two pictures of 8192 x 4096 pixels within 1 GiB.
constexpr std::uint64_t kDiffMiB = 960;

struct Metric {
    const char* name;
    const char* meaning;
    double (*value)(const ImageDifference&);
};
double share(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}
constexpr Metric kMetrics[] = {
    {"max", "largest difference of a channel",
     [](const ImageDifference& d) { return d.max_absolute; }},
    {"mean", "mean difference of the channels",
     [](const ImageDifference& d) { return d.mean_absolute; }},
    {"rmse", "root of the mean squared difference",
     [](const ImageDifference& d) { return d.rmse; }},
    {"different", "share of pixels that are not identical",
     [](const ImageDifference& d) { return share(d.pixels - d.identical, d.pixels); }},
    {"beyond_one_step", "share of pixels more than 1/255 apart",
     [](const ImageDifference& d) { return share(d.pixels - d.within_one_step, d.pixels); }},
};

const Metric& find_metric(const std::string& name) {
    std::string known;
    for (const Metric& metric : kMetrics) {
        if (name == metric.name) return metric;
        known += fmt::format("{}{}", known.empty() ? "" : ", ", metric.name);
    }
    throw Error(ErrorKind::Usage, fmt::format("unknown metric '{}'; known: {}", name, known));
}

void warn_of_nothing(const std::string& path, const Image& image) {
    if (image.held.are_none()) tell("warning: {}: {}\n", path, kNoPixelsHeld);
}

/// If only one of the pictures is that of a full frame of which the file holds a part of the size
/// of the other, keeps this part.
void keep_common(Image& a, Image& b) {
    const auto fits = [](const Image& whole, const Image& part) {
        return whole.held.width == part.width && whole.held.height == part.height;
    };
    if (a.width == b.width && a.height == b.height) return;
    if (fits(a, b)) {
        a = held_part(a);
    } else if (fits(b, a)) {
        b = held_part(b);
    }
}

}  // namespace

void add_diff(CLI::App& app, int& exit_status) {
    struct Arguments {
        std::string a, b, output, metric = "max";
        double max = 0;
        bool json = false;
        ImageLimitArguments limits{.max_mib = kDiffMiB};
    };
    CLI::App* command = app.add_subcommand("diff", "Compare two pictures; exit 1 above the bound");
    const auto args = std::make_shared<Arguments>();
    command->add_option("a", args->a, "First picture")->type_name("FILE")->required();
    command->add_option("b", args->b, "Second picture")->type_name("FILE")->required();
    std::string metrics;
    for (const Metric& m : kMetrics) metrics += fmt::format("\n  {:<16} {}", m.name, m.meaning);
    command->add_option("--metric", args->metric, "Metric that --max bounds:" + metrics)
        ->type_name("NAME")
        ->capture_default_str();
    command->add_option("--max", args->max, "Largest value of the metric that passes")
        ->type_name("X")
        ->check(number_in(0.0, std::numeric_limits<double>::infinity()))
        ->capture_default_str();
    command
        ->add_option("-o,--output", args->output,
                     "Write the difference picture, scaled to full range")
        ->type_name("FILE");
    command->add_flag("--json", args->json, "Print JSON");
    args->limits.add_to(*command);
    command->callback([args, &exit_status] {
        const Metric& metric = find_metric(args->metric);
        if (!args->output.empty()) {
            check_image_suffix(args->output);
            if (is_same_file(args->output, args->a) || is_same_file(args->output, args->b)) {
                throw Error(ErrorKind::Usage,
                            "-o: " + args->output + " is one of the pictures that are compared");
            }
        }
        ImageLimits limits = args->limits.limits();
        Image a = read_image(args->a, limits);
        limits.max_bytes -= a.samples.size() * sizeof(float);
        Image b = read_image(args->b, limits);
        warn_of_nothing(args->a, a);
        warn_of_nothing(args->b, b);
        keep_common(a, b);
        const ImageDifference d = difference(a, b);
        const double value = metric.value(d);
        const bool holds = value <= args->max;
        if (args->json) {
            nlohmann::ordered_json report = {{"pixels", d.pixels},
                                             {"identical", d.identical},
                                             {"within_one_step", d.within_one_step}};
            for (const Metric& m : kMetrics) report[m.name] = m.value(d);
            report["holds"] = holds;
            print("{}\n", report.dump(2));
        } else {
            print(
                "{} of {} pixels identical ({:.4f} %), {:.4f} % within 1/255, max {:.6g}, rmse "
                "{:.6g}, "
                "psnr {:.2f} dB\n",
                d.identical, d.pixels, 100.0 * share(d.identical, d.pixels),
                100.0 * share(d.within_one_step, d.pixels), d.max_absolute, d.rmse, d.psnr_db);
        }
        if (!args->output.empty()) {
            ImageWriteOptions write;
            write.encoding = Encoding::LinearTruncated;
            write_image(args->output, difference_image(a, b), write);
        }
        exit_status = holds ? kDone : kCheckFailed;
    });
}

}  // namespace alhazen::cli
