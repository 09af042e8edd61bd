#pragma once
/// The sub-commands. Each function adds one to the command line; its callback sets `exit_status`.

#include <CLI/CLI.hpp>

namespace alhazen::cli {

/// Exit statuses (docs/reference/command_line.md).
enum ExitStatus {
    kDone = 0,
    kCheckFailed = 1,
    kUsage = 2,
    kBadScene = 3,
    kBadFile = 4,
    kOutOfResource = 5,
    kNotStrict = 6,
    kStopped = 75,
};

void add_render(CLI::App& app, int& exit_status);
void add_convert(CLI::App& app, int& exit_status);
void add_generate(CLI::App& app, int& exit_status);
void add_info(CLI::App& app, int& exit_status);
void add_verify(CLI::App& app, int& exit_status);
void add_compare(CLI::App& app, int& exit_status);
void add_spans(CLI::App& app, int& exit_status);
void add_thickness(CLI::App& app, int& exit_status);
void add_inside(CLI::App& app, int& exit_status);
void add_measure(CLI::App& app, int& exit_status);
void add_samples(CLI::App& app, int& exit_status);
void add_view(CLI::App& app, int& exit_status);
void add_vector(CLI::App& app, int& exit_status);
void add_section(CLI::App& app, int& exit_status);
void add_explain(CLI::App& app, int& exit_status);
void add_diff(CLI::App& app, int& exit_status);
void add_list(CLI::App& app, int& exit_status);

}  // namespace alhazen::cli
