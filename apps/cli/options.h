#pragma once
/// Options that several commands share, and their parsers.

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/imaging/film/film.h"
#include "alhazen/session/load.h"

namespace alhazen::cli {

struct Size {
    int width = 0, height = 0;
};

/// Parses "640x480". Throws Error (Usage).
[[nodiscard]] Size parse_size(const std::string& text);
/// Parses "x0,y0,x1,y1" in pixels. Throws Error (Usage).
[[nodiscard]] PixelBox parse_crop(const std::string& text);

/// Throws Error (Usage) if both --view and --camera are given.
void check_one_view(const std::string& view, const std::string& camera);

/// Accepts a finite number above 0.
[[nodiscard]] CLI::Validator positive_number();

/// Accepts a number from lo to hi. Unlike CLI::Range it refuses nan, which passes every comparison.
[[nodiscard]] CLI::Validator number_in(double lo, double hi);

/// Reads a limit of time, seconds or with a unit (90s, 5m, 2h), as a number of seconds.
[[nodiscard]] CLI::Validator time_in_seconds();

/// Adds an option of a limit of time under these names.
template <class Seconds>
CLI::Option* add_time_limit(CLI::App& command, const std::string& names, Seconds& seconds,
                            const std::string& what) {
    return command.add_option(names, seconds, what)
        ->type_name("90s|5m|SECONDS")
        ->transform(time_in_seconds());
}

/// Refuses a sign, which CLI11 takes: it reads "-1" into an unsigned number as a huge one.
[[nodiscard]] CLI::Validator unsigned_number();

/// Adds the option --strict (LoadOptions::strict).
void add_strict(CLI::App& command, bool& strict);

/// Adds the option --quiet.
void add_quiet(CLI::App& command, bool& quiet);

/// Size limits of pictures read from files.
struct ImageLimitArguments {
    std::uint64_t max_pixels = ImageLimits{}.max_pixels;
    int max_side = ImageLimits{}.max_side;
    std::uint64_t max_mib = ImageLimits{}.max_bytes >> 20;

    void add_to(CLI::App& command);
    [[nodiscard]] ImageLimits limits() const;
};

/// The scene argument, and what is read of its file.
struct ReadArguments {
    std::string scene;
    std::vector<std::string> allow_paths;
    std::optional<double> time;
    bool takes_time_limit = false;     ///< --time with a unit is an older form of --time-limit
    std::optional<double> time_limit;  ///< that of --time, seconds
    bool takes_shutter = false;        ///< the command has the option --shutter
    std::string shutter;               ///< opening and closing time; empty: not given
    std::string animation;
    std::vector<std::string> objects;
    std::string view_script;
    bool strict = false;
    ImageLimitArguments image_limits;
    std::optional<std::uint64_t> max_import_mib;
    int threads = 0;

    void add_to(CLI::App& command);
    /// The shutter, if given. Throws Error (Usage).
    [[nodiscard]] std::optional<Shutter> shutter_option() const;
    /// Parses a value of --time: a moment; with a unit, a time limit.
    void read_time(const std::string& text);
    /// The options of reading. Throws Error (Usage).
    [[nodiscard]] LoadOptions load_options() const;
};

/// The accelerator, its build and the evaluator of CSG solids.
struct AcceleratorArguments {
    std::string accelerator;
    std::string default_accelerator;  ///< its value without the option
    std::string build_quality = "default";
    bool takes_auto_build = false;  ///< --build may be auto, which is then the default
    std::uint32_t width = BuildOptions{}.width;
    std::string csg;
    bool compact = false;

    void add_to(CLI::App& command, const std::string& default_name);
    /// True if the command chooses the quality itself.
    [[nodiscard]] bool chooses_build() const { return takes_auto_build && build_quality == "auto"; }
    /// True if an accelerator or an option of its build is given, other than the default.
    [[nodiscard]] bool names_accelerator() const;
    /// Throws Error (Usage) for an unknown quality or width.
    [[nodiscard]] BuildOptions build_options() const;
    /// Throws Error (Usage) for an unknown accelerator, quality, width or evaluator.
    [[nodiscard]] CompileOptions compile_options() const;
};

/// A scene that is read and built.
struct SceneArguments : ReadArguments, AcceleratorArguments {
    void add_to(CLI::App& command, const std::string& default_name);
    /// Throws Error (Usage) as its parts do.
    [[nodiscard]] LoadOptions load_options() const;
    /// For `user`, which has no accelerator: tells that options of one have no effect.
    void tell_idle_accelerator(const std::string& user, bool quiet) const;
};

/// Tells that options have no effect; an Error (Usage) with `strict`.
void tell_idle_options(const std::string& what, bool strict, bool quiet);

/// Prints warnings to stderr, one per line.
void print_warnings(const Diagnostics& diagnostics);

/// Writes a report to a file or, for "-", to stdout.
void write_report(const std::string& path, const std::string& text);

}  // namespace alhazen::cli
