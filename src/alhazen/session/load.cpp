#include "alhazen/session/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <system_error>
#include <utility>

#include "alhazen/accel/accelerator_names.h"
#include "alhazen/accel/core/accelerator_settings.h"
#include "alhazen/base/error.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/formats/importer_list.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/parallel/thread_start.h"
#include "alhazen/session/environment_option.h"
#include "alhazen/session/seen_lights.h"
#include "alhazen/session/shutter.h"
#include "alhazen/session/statistics.h"

namespace alhazen {

namespace {

void report_phase(const LoadOptions& options, const char* phase, std::size_t done) {
    if (options.progress != nullptr) options.progress->update(phase, done, 1);
}

/// True if reading the file takes longer than starting threads.
bool is_long(const std::filesystem::path& path) {
    constexpr std::uintmax_t kLong = std::uintmax_t{128} << 10;
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    return !failed && size >= kLong;
}

/// Runs `work` as the phase "build".
template <class Work>
void run_build_phase(LoadedScene& loaded, const LoadOptions& options, Work&& work) {
    report_phase(options, "build", 0);
    const Stopwatch time;
    ThreadLimit(options.threads).run(work);
    loaded.build_seconds += time.seconds();
    loaded.build_peak_bytes = peak_rss_bytes();
    report_phase(options, "build", 1);
}

void add_aggregate(LoadedScene& loaded, const LoadOptions& options) {
    CompileOptions compile = options.compile;
    if (const std::string idle = idle_build_options(loaded.description, compile); !idle.empty()) {
        if (options.strict) throw Error(ErrorKind::Usage, idle);
        loaded.diagnostics.warning({}, idle);
    }
    if (options.choose_quality) compile.build.quality = options.choose_quality(loaded);
    loaded.quality = compile.build.quality;
    if (options.keep_meshes) {
        build_aggregate(loaded.description, compile, loaded.scene);
    } else {
        build_aggregate_taking_meshes(loaded.description, compile, loaded.scene);
    }
}

}  // namespace

std::string idle_build_options(const SceneDescription& description, const CompileOptions& compile) {
    const BuildOptions& build = compile.build;
    const BuildOptions usual;
    if (build.quality == usual.quality && build.leaves == usual.leaves &&
        build.width == usual.width) {
        return {};
    }
    const auto is_wide = [](const std::string& accelerator) {
        return parse_accelerator(accelerator).name == kDefaultAccelerator;
    };
    if (is_wide(compile.accelerator) ||
        std::ranges::any_of(description.objects, [&](const ObjectDescription& object) {
            return !object.accelerator.empty() && is_wide(object.accelerator);
        })) {
        return {};
    }
    return fmt::format(
        "accelerator '{}' is built without --build, --width and --compact: they are for '{}'",
        parse_accelerator(compile.accelerator).name, kDefaultAccelerator);
}

SceneDescription load_description(const std::filesystem::path& path, const LoadOptions& options,
                                  Diagnostics& diagnostics) {
    SceneDescription description;
    const auto import = [&] {
        ThreadLimit(options.threads).run([&] {
            description = import_scene(path, options.import, diagnostics);
        });
    };
    if (is_long(path)) {
        run_while_threads_start(options.threads, import);
    } else {
        import();
    }
    if (options.shutter) {
        open_shutter_of(description, options.import, *options.shutter, diagnostics);
    }
    if (options.strict) diagnostics.throw_if_warnings();
    return description;
}

LoadedScene load(const std::filesystem::path& path, const LoadOptions& options) {
    report_phase(options, "load", 0);
    const Stopwatch load_time;
    Diagnostics diagnostics;
    SceneDescription description = load_description(path, options, diagnostics);
    const double seconds = load_time.seconds();
    report_phase(options, "load", 1);
    LoadedScene loaded = load(std::move(description), std::move(diagnostics), options);
    loaded.load_seconds += seconds;
    return loaded;
}

LoadedScene load(SceneDescription description, Diagnostics diagnostics,
                 const LoadOptions& options) {
    LoadedScene loaded;
    const Stopwatch load_time;
    loaded.description = std::move(description);
    loaded.diagnostics = std::move(diagnostics);
    add_seen_lights(loaded.description);
    loaded.load_seconds = load_time.seconds();
    loaded.load_peak_bytes = peak_rss_bytes();
    run_build_phase(loaded, options, [&] {
        loaded.scene = compile_without_geometry(loaded.description);
        warn_of_bad_texels(loaded);
        if (options.strict) loaded.diagnostics.throw_if_warnings();
        if (options.with_aggregate) add_aggregate(loaded, options);
    });
    return loaded;
}

void build_aggregate(LoadedScene& loaded, const LoadOptions& options) {
    if (loaded.scene.aggregate) return;
    run_build_phase(loaded, options, [&] { add_aggregate(loaded, options); });
}

}  // namespace alhazen
