#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/lower_case.h"
#include "alhazen/session/conversion/convert.h"
#include "alhazen/session/generators/generate.h"
#include "commands.h"
#include "messages.h"
#include "options.h"

namespace alhazen::cli {

namespace {

struct GenerateArguments {
    std::string name, output, size;
    bool sized = false;  ///< --size was given
    std::optional<int> digits;
    bool quiet = false;
};

std::optional<std::uint64_t> size_of(const GenerateArguments& args) {
    if (!args.sized) return std::nullopt;
    const char* const end = args.size.data() + args.size.size();
    std::uint64_t size = 0;
    const auto [rest, status] = std::from_chars(args.size.data(), end, size);
    const std::uint64_t most = find_generator(args.name).max_size;
    if (status != std::errc{} || rest != end || size < 1 || size > most) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--size '{}' of {}: expected 1 to {}", args.size, args.name, most));
    }
    return size;
}

/// Writes the NFF file; returns the number of bytes.
std::uint64_t write_nff(const GenerateArguments& args) {
    const std::string text =
        generate_nff(args.name, size_of(args), args.digits.value_or(NffText::kPublishedDigits));
    write_file_atomically(args.output, text);
    return text.size();
}

std::uint64_t write_scene(const GenerateArguments& args) {
    if (args.digits) throw Error(ErrorKind::Usage, "--digits is for .nff files");
    try {
        check_convert_target({}, args.output);
    } catch (const Error& error) {
        throw Error(ErrorKind::Usage, fmt::format("{}, .nff (scenes of the SPD)", error.what()));
    }
    return convert(generate(args.name, size_of(args)), args.output,
                   {.meshes_only_setting = "", .tolerance_setting = ""})
        .bytes;
}

int run(const GenerateArguments& args) {
    const bool nff = lower_suffix(args.output) == ".nff";
    const std::uint64_t bytes = nff ? write_nff(args) : write_scene(args);
    if (!args.quiet) tell("{}: {:.1f} MB\n", args.output, 1e-6 * static_cast<double>(bytes));
    return kDone;
}

}  // namespace

void add_generate(CLI::App& app, int& exit_status) {
    std::string names;
    for (const GeneratorEntry& entry : generators()) {
        names += fmt::format("\n  {:<21}{} (SIZE: {}, {})", entry.name, entry.description,
                             entry.size, entry.default_size);
    }
    CLI::App* command = app.add_subcommand(
        "generate", "Write a scene of any size: the standard databases and others");
    command->footer("Names:" + names);
    const auto args = std::make_shared<GenerateArguments>();
    command->add_option("name", args->name, "Name of the scene; see below")
        ->required()
        ->type_name("NAME");
    command->add_option("--size", args->size, "Size; default: as listed below")->type_name("N");
    command
        ->add_option("--digits", args->digits,
                     "Significant digits of the numbers in .nff (6, as published)")
        ->type_name("N");
    command
        ->add_option("-o,--output", args->output,
                     "File to write: .alhazen; .nff of the SPD; .ply .obj .stl of triangles")
        ->required()
        ->type_name("OUT");
    add_quiet(*command, args->quiet);
    command->callback([args, command, &exit_status] {
        args->sized = command->count("--size") > 0;
        exit_status = run(*args);
    });
}

}  // namespace alhazen::cli
