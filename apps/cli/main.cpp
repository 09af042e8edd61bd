/// The command line: `alhazen COMMAND`. Results go to stdout, progress and messages to stderr.

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iterator>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/base/heap.h"
#include "alhazen/session/statistics.h"
#include "commands.h"
#include "messages.h"
#include "stop_signals.h"

namespace {

using namespace alhazen;
using namespace alhazen::cli;

int exit_status_of(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Usage:
            return kUsage;
        case ErrorKind::Scene:
            return kBadScene;
        case ErrorKind::File:
            return kBadFile;
        case ErrorKind::Resource:
            return kOutOfResource;
        case ErrorKind::Render:
            break;
    }
    return kCheckFailed;
}

/// Adds the command called `name`; without a name all, for help.
/// Throws Error (Usage) for a name of none.
void add_commands(CLI::App& app, std::string_view name, int& exit_status) {
    struct Row {
        std::string_view name;
        void (*add)(CLI::App&, int&);
    };
    static constexpr Row kRows[] = {
        {"render", add_render},       {"convert", add_convert}, {"generate", add_generate},
        {"info", add_info},           {"verify", add_verify},   {"compare", add_compare},
        {"explain", add_explain},     {"spans", add_spans},     {"inside", add_inside},
        {"thickness", add_thickness}, {"measure", add_measure}, {"section", add_section},
        {"samples", add_samples},     {"vector", add_vector},   {"view", add_view},
        {"diff", add_diff},           {"list", add_list},
    };
    const auto* const named = std::find_if(std::begin(kRows), std::end(kRows),
                                           [&](const Row& row) { return row.name == name; });
    if (named != std::end(kRows)) return named->add(app, exit_status);
    if (!name.empty() && !name.starts_with('-')) {
        std::string known;
        for (const Row& row : kRows) known += (known.empty() ? "" : ", ") + std::string(row.name);
        throw Error(ErrorKind::Usage,
                    fmt::format("there is no command '{}'; expected {}", name, known));
    }
    for (const Row& row : kRows) row.add(app, exit_status);
}

/// The arguments, the last one first, without the name of the program. `help COMMAND` stands for
/// `COMMAND --help`, `help help` for `help`. Throws Error (Usage) for `help` of several commands.
std::vector<std::string> arguments_from_last(int argc, char** argv) {
    std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    if (!arguments.empty() && arguments.front() == "help") {
        const bool of_itself = arguments.size() > 1 && arguments[1] == "help";
        const auto is_topic = [](const std::string& text) { return !text.starts_with('-'); };
        if (std::count_if(arguments.begin() + 1, arguments.end(), is_topic) > 1) {
            throw Error(ErrorKind::Usage, "help: expected one command");
        }
        arguments.erase(arguments.begin(), arguments.begin() + (of_itself ? 2 : 1));
        arguments.emplace_back("--help");
    }
    std::reverse(arguments.begin(), arguments.end());
    return arguments;
}

/// The message for a wrong command line. That of CLI11 for a repeated option counts values, and
/// that for a value of another kind does not say of which. Switches of other programs get a hint.
std::string failure_message(const CLI::App* app, const CLI::Error& error) {
    std::string text = CLI::FailureMessage::simple(app, error);
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
        // Switches of the programs for .ray files.
        constexpr std::pair<std::string_view, std::string_view> kKnown[] = {
            {" -w", "; the size of a picture is --size WIDTHxHEIGHT"},
            {" -r", "; the depth of recursion is --depth N"},
        };
        for (const auto& [name, hint] : kKnown) {
            const std::string line = text.substr(0, text.find('\n')) + " ";
            if (line.find(std::string(name) + " ") == std::string::npos) continue;
            text.insert(line.size() - 1, hint);
        }
        return text;
    }
    constexpr std::string_view kOther = "Could not convert: ";
    if (text.starts_with(kOther)) {
        const std::size_t value = text.find(" = ");
        const std::size_t end = text.find('\n');
        if (value < end) {
            const std::string option = text.substr(kOther.size(), value - kOther.size());
            text.replace(0, end,
                         fmt::format("{}: expected a number of its kind (see --help), not {}",
                                     option, text.substr(value + 3, end - value - 3)));
        }
        return text;
    }
    const std::size_t begin = text.find(": At Most 1 required but received ");
    if (begin == std::string::npos) return text;
    return text.replace(begin, text.find('\n', begin) - begin, ": was given more than once");
}

int run(int argc, char** argv) {
    CLI::App app{
        "Alhazen traces rays through exact solids and meshes.\n"
        "Example: alhazen render scene.alhazen -o picture.png --spp 16"};
    app.name("alhazen");
    app.set_version_flag("--version", fmt::format("alhazen {}", version()));
    app.require_subcommand(1);
    app.footer(
        "Exit status: 0 done; 1 a check did not hold or the render failed; 2 wrong usage; 3 bad "
        "scene;\n"
        "4 a file could not be read or written; 5 out of a resource; 6 --strict, and samples were "
        "not finite;\n"
        "75 stopped by a signal, what was done is written.");
    int exit_status = kDone;
    std::vector<std::string> arguments = arguments_from_last(argc, argv);
    add_commands(app, arguments.empty() ? "" : arguments.back(), exit_status);
    app.failure_message(failure_message);
    try {
        app.parse(std::move(arguments));
    } catch (const CLI::Success& success) {  // --help, --version
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        (void)app.exit(error);
        return kUsage;
    }
    return exit_status;
}

/// Opens closed standard streams: otherwise the next opened file would get their number and receive
/// messages.
void open_closed_streams() {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
        if (fcntl(stream, F_GETFD) == -1) (void)open("/dev/null", O_RDWR);
    }
}

}  // namespace

int main(int argc, char** argv) {
    prepare_heap();
    open_closed_streams();
    fail_instead_of_dying_on_writes();
    exit_on_signals();
    try {
        const int status = run(argc, argv);
        // A full disk behind a redirection is detected here.
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
            tell("alhazen: standard output could not be written\n");
            return kBadFile;
        }
        return status;
    } catch (const Error& error) {
        tell("alhazen: {}\n", error.what());
        return exit_status_of(error.kind());
    } catch (const std::bad_alloc&) {
        tell("alhazen: out of memory\n");
        return kOutOfResource;
    } catch (const std::exception& error) {
        tell("alhazen: internal error: {}\n", error.what());
        return kCheckFailed;
    }
}
