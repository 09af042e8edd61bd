#include <fmt/format.h>

#include <memory>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/lower_case.h"
#include "alhazen/session/sample_figure.h"
#include "commands.h"
#include "messages.h"
#include "options.h"

namespace alhazen::cli {

namespace {

struct SamplesArguments {
    std::string name, output;
    int dimension = 0;
    SampleStudyOptions study;
};

int run_samples(const SamplesArguments& args) {
    const SamplerEntry* sampler = find_sampler(args.name);
    if (sampler == nullptr) {
        std::string names;
        for (const SamplerEntry& entry : samplers()) {
            names += (names.empty() ? "" : ", ") + std::string(entry.name);
        }
        throw Error(ErrorKind::Usage,
                    fmt::format("samples '{}': unknown; known: {}", args.name, names));
    }
    if (args.dimension % 2 != 0) {
        throw Error(ErrorKind::Usage, fmt::format("--dimension {}: expected an even number, the "
                                                  "first of a pair",
                                                  args.dimension));
    }
    SampleStudyOptions options = args.study;
    options.pair = static_cast<std::uint32_t>(args.dimension / 2);
    if (!args.output.empty() && args.output != "-") {
        if (lower_suffix(args.output) != ".svg") {
            throw Error(ErrorKind::Usage,
                        fmt::format("-o '{}': expected a file .svg", args.output));
        }
        check_writable(args.output);
    }
    const SampleStudy study = study_sampler(*sampler, options);
    if (!args.output.empty()) write_report(args.output, sample_figure(study));
    if (args.output == "-") return kDone;
    print(
        "{}: {} points, means of {} sets: star discrepancy {:.6f}, nearest points {:.4f} / "
        "root({})\n",
        args.name, options.points, study.options.sets, study.discrepancy, study.distance,
        options.points);
    return kDone;
}

}  // namespace

void add_samples(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand(
        "samples", "Draw a sampler: its points, their periodogram and its radial mean");
    const auto args = std::make_shared<SamplesArguments>();
    command->add_option("name", args->name, "Sampler; see `alhazen list samplers`")
        ->required()
        ->type_name("NAME");
    command->add_option("-o,--output", args->output, "SVG to write; - for stdout")
        ->type_name("FILE");
    command->add_option("-n,--points", args->study.points, "Samples of a pixel")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(1u, kMostStudied));
    command
        ->add_option("--sets", args->study.sets, "Pixels in the means; 0: as many as take moments")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(0u, kMostStudiedSets));
    command->add_option("--dimension", args->dimension, "The first of the two that are drawn")
        ->type_name("D")
        ->capture_default_str()
        ->check(CLI::Range(0, 1 << 16));
    command->add_option("--seed", args->study.seed, "Seed of the samples")
        ->type_name("N")
        ->capture_default_str()
        ->check(unsigned_number());
    command->callback([args, &exit_status] { exit_status = run_samples(*args); });
}

}  // namespace alhazen::cli
