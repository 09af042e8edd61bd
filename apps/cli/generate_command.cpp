#include <fmt/format.h>

#include "alhazen/session/convert.h"
#include "alhazen/session/generate.h"
#include "commands.h"
#include "messages.h"

namespace alhazen::cli {

namespace {

struct GenerateArguments {
    std::string name, output;
    std::uint64_t size = 1000;
    bool quiet = false;
};

int run(const GenerateArguments& args) {
    check_convert_target({}, args.output);
    const ConvertReport report = convert(generate(args.name, args.size), args.output);
    if (!args.quiet) {
        tell("{}: {:.1f} MB\n", args.output, 1e-6 * static_cast<double>(report.bytes));
    }
    return kDone;
}

}  // namespace

void add_generate(CLI::App& app, int& exit_status) {
    std::string names;
    for (const GeneratorEntry& entry : generators()) {
        names += fmt::format("\n  {:<18}{} (SIZE: {})", entry.name, entry.description, entry.size);
    }
    CLI::App* command =
        app.add_subcommand("generate", "Write a scene of any size in the native format");
    command->footer("Names:" + names);
    const auto args = std::make_shared<GenerateArguments>();
    command->add_option("name", args->name, "Which one; see below")->required()->type_name("NAME");
    command->add_option("--size", args->size, "How much of it")->capture_default_str();
    command->add_option("-o,--output", args->output, "File to write, .alhazen")
        ->required()
        ->type_name("OUT");
    command->add_flag("-q,--quiet", args->quiet, "No summary");
    command->callback([args, &exit_status] { exit_status = run(*args); });
}

}  // namespace alhazen::cli
