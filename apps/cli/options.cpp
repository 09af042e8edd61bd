#include "options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>
#include <vector>

#include "alhazen/accel/accelerator_names.h"
#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/csg/csg_evaluator.h"
#include "alhazen/solids/solid_queries_json.h"
#include "messages.h"

namespace alhazen::cli {

namespace {

/// More warnings would hide later output.
constexpr std::size_t kMaxShownWarnings = 20;

/// Integers separated by `separator`; empty for any other text.
std::vector<int> parse_integers(const std::string& text, char separator) {
    std::vector<int> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        int number = 0;
        const auto [next, status] = std::from_chars(at, end, number);
        if (status != std::errc{}) return {};
        numbers.push_back(number);
        if (next == end) return numbers;
        if (*next != separator) return {};
        at = next + 1;
    }
}

/// The number that is all of the text.
std::optional<double> number_of(std::string_view text) {
    double value = 0.0;
    const auto [read, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || read != text.data() + text.size()) return std::nullopt;
    return value;
}

/// The unit of time that ends the text, in seconds.
std::optional<double> seconds_of_unit(std::string_view text) {
    if (text.ends_with('s')) return 1.0;
    if (text.ends_with('m')) return 60.0;
    if (text.ends_with('h')) return 3600.0;
    return std::nullopt;
}

/// A time in seconds, or with a unit.
std::optional<double> seconds_in(std::string_view text) {
    const std::optional<double> unit = seconds_of_unit(text);
    if (unit) text.remove_suffix(1);
    std::optional<double> value = number_of(text);
    if (value && unit) *value *= *unit;
    return value;
}

}  // namespace

Size parse_size(const std::string& text) {
    const std::vector<int> n = parse_integers(text, 'x');
    if (n.size() != 2 || n[0] < 1 || n[1] < 1) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--size '{}': expected WIDTHxHEIGHT, such as 640x480", text));
    }
    return {n[0], n[1]};
}

PixelBox parse_crop(const std::string& text) {
    const std::vector<int> n = parse_integers(text, ',');
    if (n.size() != 4) {
        throw Error(
            ErrorKind::Usage,
            fmt::format("--crop '{}': expected X0,Y0,X1,Y1 in pixels from the top left", text));
    }
    return {n[0], n[1], n[2], n[3]};
}

void check_one_view(const std::string& view, const std::string& camera) {
    if (view.empty() || camera.empty()) return;
    throw Error(ErrorKind::Usage, "--view and --camera exclude each other");
}

CLI::Validator time_in_seconds() {
    return {[](std::string& text) {
                const std::optional<double> seconds = seconds_in(text);
                if (!seconds) {
                    return fmt::format(
                        "expected seconds, or a time with a unit, as 90s, 5m or 2h, "
                        "not {}",
                        text);
                }
                text = fmt::format("{}", *seconds);
                return std::string();
            },
            ""};
}

CLI::Validator positive_number() {
    return {[](std::string& text) {
                double value = 0.0;
                const bool read = CLI::detail::lexical_cast(text, value);
                if (read && value > 0.0 && std::isfinite(value)) return std::string();
                return fmt::format("expected a number above 0, not {}", text);
            },
            "POSITIVE"};
}

CLI::Validator unsigned_number() {
    return {[](const std::string& text) {
                if (text.starts_with('-')) return fmt::format("expected 0 or more, not {}", text);
                // CLI11 takes the largest number for one beyond it.
                std::uint64_t number = 0;
                const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
                return read.ec == std::errc::result_out_of_range
                           ? fmt::format("expected at most 2^64 - 1, not {}", text)
                           : std::string();
            },
            ""};
}

CLI::Validator number_in(double lo, double hi) {
    const std::string range = fmt::format("FLOAT in [{:g} - {:g}]", lo, hi);
    return {[lo, hi](std::string& text) {
                double value = std::numeric_limits<double>::quiet_NaN();
                const bool read = CLI::detail::lexical_cast(text, value);
                if (read && value >= lo && value <= hi) return std::string();
                return fmt::format("Value {} not in range [{:g} - {:g}]", text, lo, hi);
            },
            range};
}

/// A count from 1, as digits.
static CLI::Validator count_up_to(std::uint64_t most) {
    return {[most](std::string& text) {
                std::uint64_t value = 0;
                const bool read = CLI::detail::lexical_cast(text, value);
                if (read && value >= 1 && value <= most) return std::string();
                return fmt::format("expected a whole number from 1 to {}, not {}", most, text);
            },
            fmt::format("INT in [1 - {}]", most)};
}

void add_strict(CLI::App& command, bool& strict) {
    command.add_flag("--strict", strict,
                     "Warnings about the scene are errors: exit 3, and nothing is done");
}

void add_quiet(CLI::App& command, bool& quiet) {
    command.add_flag("-q,--quiet", quiet, "No progress, no warnings, no summary");
}

void ImageLimitArguments::add_to(CLI::App& command) {
    command
        .add_option("--max-image-pixels", max_pixels,
                    "Larger pictures are refused before they are decoded")
        ->capture_default_str()
        ->type_name("N")
        ->check(count_up_to(1'000'000'000'000'000));
    command.add_option("--max-image-side", max_side, "The same for longer sides")
        ->capture_default_str()
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 20));
    command
        .add_option("--max-image-mib", max_mib,
                    "Memory for all pictures together, also while they are read")
        ->capture_default_str()
        ->type_name("N")
        ->check(count_up_to(1'000'000'000));
}

ImageLimits ImageLimitArguments::limits() const {
    return {.max_side = max_side, .max_pixels = max_pixels, .max_bytes = max_mib << 20};
}

void AcceleratorArguments::add_to(CLI::App& command, const std::string& default_name) {
    accelerator = default_accelerator = default_name;
    command
        .add_option("--accelerator", accelerator, "Accelerator; see `alhazen list accelerators`")
        ->type_name("NAME[:SETTING=VALUE,...]")
        ->capture_default_str();
    command
        .add_option_function<std::string>(
            "--bound",
            [this](const std::string& bound) {
                if (accelerator != default_accelerator) {
                    throw Error(ErrorKind::Usage,
                                "--bound stands for --accelerator bounding_volumes:bound=...: give "
                                "one of the two");
                }
                accelerator = "bounding_volumes:bound=" + bound;
            },
            "A bound around every primitive and no hierarchy: sphere, ellipsoid, box, slabs3, "
            "slabs7 or slabs13; short for --accelerator bounding_volumes:bound=NAME")
        ->type_name("NAME");
    if (takes_auto_build) build_quality = "auto";
    command
        .add_option("--build", build_quality,
                    takes_auto_build
                        ? "Work that goes into the accelerator: fast, default, high, or auto: fast "
                          "where the rays of the picture are few for the triangles, else default"
                        : "Work that goes into the accelerator: fast, default or high")
        ->type_name("QUALITY")
        ->capture_default_str();
    command
        .add_option("--width", width,
                    "Children of a node of the accelerator: 4, 8 or 16; the hits are the same")
        ->type_name("N")
        ->capture_default_str();
    csg = kDefaultCsgEvaluator;
    command.add_option("--csg", csg, "Evaluator of CSG solids; see `alhazen list csg`")
        ->type_name("NAME")
        ->capture_default_str();
    command.add_flag("--compact", compact,
                     "Leaves hold the numbers of triangles, not their vertices: a fourth of the "
                     "memory, slower");
}

void ReadArguments::add_to(CLI::App& command) {
    command.add_option("scene", scene, "Scene file; its format is recognised by content")
        ->required()
        ->type_name("SCENE");
    command
        .add_option("--allow-path", allow_paths,
                    "Another folder that files named by the scene may lie in; may be repeated")
        ->type_name("DIR")
        ->expected(1)
        ->take_all();
    command
        .add_option_function<std::vector<std::string>>(
            "--time",
            [this](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) read_time(text);
            },
            fmt::format("Moment of the file's animations; default: the pose without them{}",
                        takes_time_limit ? ". With a unit, as 5m: older form of --time-limit" : ""))
        ->expected(1)
        ->take_all()
        ->type_name("SECONDS");
    if (takes_shutter) {
        command
            .add_option("--shutter", shutter,
                        "When the shutter opens and closes, instead of what the file says: seconds "
                        "of its animations, or the unit of its keys. `distributed` and the "
                        "renderers of light transport render all of this time, the others its "
                        "beginning")
            ->type_name("OPEN,CLOSE");
    }
    command.add_option("--animation", animation, "Apply only this animation")
        ->type_name("NAME|INDEX");
    command
        .add_option("--object", objects, "Show only the objects of these names; may be repeated")
        ->type_name("NAME,...")
        ->delimiter(',')
        ->expected(1)
        ->take_all();
    command
        .add_option("--view-script", view_script,
                    "BRL-CAD: a file with the view commands of `rt`; the first frame becomes the "
                    "default camera")
        ->type_name("FILE");
    add_strict(command, strict);
    image_limits.add_to(command);
    command
        .add_option("--max-import-mib", max_import_mib,
                    "Memory for the meshes and instances that a glTF file makes of shared data; "
                    "default: 64, and 64 times the file")
        ->type_name("N")
        ->check(count_up_to(1'000'000'000));
    command.add_option("-t,--threads", threads, "Threads; 0 = all cores")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(0, 4096))
        ->envname("ALHAZEN_THREADS");
}

void ReadArguments::read_time(const std::string& text) {
    const bool is_limit = takes_time_limit && seconds_of_unit(text);
    const std::optional<double> value = is_limit ? seconds_in(text) : number_of(text);
    const bool known = value && std::isfinite(*value) && (!is_limit || *value > 0.0);
    std::optional<double>& target = is_limit ? time_limit : time;
    if (!known || target) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--time '{}': expected {}{}", text,
                                "a number of seconds, the moment of the animations",
                                takes_time_limit ? ", or a limit with a unit, as 90s, 5m or 2h "
                                                   "(older form of --time-limit); each once"
                                                 : ""));
    }
    target = value;
}

std::optional<Shutter> ReadArguments::shutter_option() const {
    if (shutter.empty()) return std::nullopt;
    const char* const expected = "OPEN,CLOSE, two finite times, the second not before the first";
    std::vector<double> times;
    try {
        times = parse_numbers(shutter, {2}, expected);
    } catch (const Error& error) {
        throw Error(ErrorKind::Usage, fmt::format("--shutter {}", error.what()));
    }
    if (!std::isfinite(times[0]) || !std::isfinite(times[1]) || times[1] < times[0]) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--shutter '{}': expected {}", shutter, expected));
    }
    if (time) {
        throw Error(ErrorKind::Usage,
                    "--shutter says when the picture is taken, --time SECONDS too: expected one of "
                    "them");
    }
    return Shutter{times[0], times[1]};
}

bool AcceleratorArguments::names_accelerator() const {
    const BuildOptions usual, build = build_options();
    return accelerator != kDefaultAccelerator || build.quality != usual.quality ||
           build.width != usual.width || build.leaves != usual.leaves;
}

BuildOptions AcceleratorArguments::build_options() const {
    BuildOptions options;
    if (!chooses_build()) {
        options.quality = find_build_quality(build_quality, takes_auto_build ? "auto" : "");
    }
    if (width > 16) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--width {}: nodes of the accelerator have 4, 8 or 16 children; "
                                "the size of a picture is --size",
                                width));
    }
    check_node_width(width);
    options.width = width;
    if (compact) options.leaves = Leaves::Indices;
    return options;
}

CompileOptions AcceleratorArguments::compile_options() const {
    // The default is a name, or what stands for all of them.
    if (accelerator != default_accelerator) check_accelerator(accelerator);
    (void)find_csg_evaluator(csg);
    CompileOptions options;
    options.accelerator = accelerator;
    options.build = build_options();
    options.csg = csg;
    return options;
}

LoadOptions ReadArguments::load_options() const {
    LoadOptions options;
    options.import.allowed_folders.assign(allow_paths.begin(), allow_paths.end());
    options.import.animation = animation;
    options.import.objects = objects;
    options.import.view_script = view_script;
    options.import.image_limits = image_limits.limits();
    if (max_import_mib) options.import.max_made_bytes = *max_import_mib << 20;
    options.shutter = shutter_option();
    if (!animation.empty() && !time && !options.shutter) {
        throw Error(ErrorKind::Usage, takes_shutter ? "--animation needs --time or --shutter: "
                                                      "without them nothing is animated"
                                                    : "--animation needs --time: without it "
                                                      "nothing is animated");
    }
    if (time) {
        if (!std::isfinite(*time)) throw Error(ErrorKind::Usage, "--time must be a finite number");
        options.import.time = time;
    }
    options.threads = threads;
    options.strict = strict;
    return options;
}

void SceneArguments::add_to(CLI::App& command, const std::string& default_name) {
    AcceleratorArguments::add_to(command, default_name);
    ReadArguments::add_to(command);
}

LoadOptions SceneArguments::load_options() const {
    LoadOptions options = ReadArguments::load_options();
    options.compile = compile_options();
    return options;
}

void SceneArguments::tell_idle_accelerator(const std::string& user, bool quiet) const {
    if (!names_accelerator()) return;
    tell_idle_options(user +
                          " has no accelerator: --accelerator, --bound, --build, --width and "
                          "--compact have no effect",
                      strict, quiet);
}

void tell_idle_options(const std::string& what, bool strict, bool quiet) {
    if (strict) throw Error(ErrorKind::Usage, what);
    if (!quiet) tell("warning: {}\n", what);
}

void print_warnings(const Diagnostics& diagnostics) {
    std::size_t shown = 0;
    for (const Diagnostic& diagnostic : diagnostics.all()) {
        if (shown++ == kMaxShownWarnings) break;
        tell("{}\n", to_string(diagnostic));
    }
    if (diagnostics.warning_count() > kMaxShownWarnings) {
        tell("({} warnings in all; `alhazen info SCENE --json` has more of them)\n",
             diagnostics.warning_count());
    }
}

void write_report(const std::string& path, const std::string& text) {
    if (path == "-") {
        std::fwrite(text.data(), 1, text.size(), stdout);
    } else {
        write_file_atomically(path, text);
    }
}

}  // namespace alhazen::cli
