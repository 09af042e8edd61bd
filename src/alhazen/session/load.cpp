#include "alhazen/session/load.h"

#include "alhazen/formats/importer_list.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/session/statistics.h"
#include "alhazen/session/stopwatch.h"

namespace alhazen {

SceneDescription load_description(const std::filesystem::path& path, const LoadOptions& options,
                                  Diagnostics& diagnostics) {
    return import_scene(path, options.import, diagnostics);
}

LoadedScene load(const std::filesystem::path& path, const LoadOptions& options) {
    const auto report = [&](const char* phase, std::size_t done) {
        if (options.progress != nullptr) options.progress->update(phase, done, 1);
    };
    LoadedScene loaded;
    report("load", 0);
    const Stopwatch load_time;
    loaded.description = load_description(path, options, loaded.diagnostics);
    loaded.load_seconds = load_time.seconds();
    loaded.load_peak_bytes = peak_rss_bytes();
    report("load", 1);
    report("build", 0);
    const Stopwatch build_time;
    ThreadLimit(options.threads).run([&] {
        loaded.scene = options.keep_meshes
                           ? compile(loaded.description, options.compile)
                           : compile_taking_meshes(loaded.description, options.compile);
    });
    loaded.build_seconds = build_time.seconds();
    loaded.build_peak_bytes = peak_rss_bytes();
    report("build", 1);
    return loaded;
}

}  // namespace alhazen
