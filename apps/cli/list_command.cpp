#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/csg/csg_evaluator.h"
#include "alhazen/formats/importer_list.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/sampling/samplers/sampler.h"
#include "alhazen/session/environment_option.h"
#include "commands.h"
#include "messages.h"

namespace alhazen::cli {

namespace {

void print_entry(const char* name, const char* description) {
    print("  {:<20} {}\n", name, description);
}

void list_renderers() {
    for (const RendererEntry& entry : renderers()) print_entry(entry.name, entry.description);
}
void list_accelerators() {
    for (const AcceleratorEntry& entry : accelerator_table()) {
        print_entry(entry.name, entry.description);
        for (const SettingDescription& setting : entry.settings()) {
            print("      {} = {}: {} ({})\n", setting.name, setting.fallback, setting.what,
                  setting.values);
        }
    }
}
void list_csg() {
    for (const CsgEvaluatorEntry& entry : csg_evaluator_table())
        print_entry(entry.name, entry.description);
}
void list_samplers() {
    for (const SamplerEntry& entry : samplers()) print_entry(entry.name, entry.description);
}
void list_filters() {
    for (const FilterEntry& entry : filters()) {
        print_entry(entry.name,
                    fmt::format("{}; radius {:g}", entry.description, entry.radius).c_str());
    }
}
void list_formats() {
    for (const Importer* importer : importers())
        print_entry(importer->name(), importer->description());
}
void list_shapes() {
    const auto print_all = []<class... S>(ShapeTypes<S...>) {
        (print_entry(S::kName, S::kClosed ? "bounds a volume" : "a surface"), ...);
    };
    print_all(AnalyticShapes{});
    print_entry("mesh", "triangles; bounds a volume where it closes");
}

void list_layers() {
    for (const AovEntry& entry : aov_table()) print_entry(entry.name, entry.description);
}
void list_environments() {
    for (const EnvironmentEntry& entry : environments()) print_entry(entry.name, entry.description);
}

struct Topic {
    const char* name;
    void (*print)();
};
constexpr Topic kTopics[] = {{"renderers", list_renderers},
                             {"accelerators", list_accelerators},
                             {"csg", list_csg},
                             {"shapes", list_shapes},
                             {"formats", list_formats},
                             {"samplers", list_samplers},
                             {"filters", list_filters},
                             {"layers", list_layers},
                             {"environments", list_environments}};

}  // namespace

void add_list(CLI::App& app, int& exit_status) {
    CLI::App* command =
        app.add_subcommand("list",
                           "List what can be chosen by name: renderers, accelerators, CSG "
                           "evaluators, shapes, formats, samplers, filters, layers, environments");
    const auto wanted = std::make_shared<std::string>();
    std::vector<std::string> names;
    for (const Topic& topic : kTopics) names.emplace_back(topic.name);
    command->add_option("what", *wanted, "Only these")
        ->type_name("WHAT")
        ->check(CLI::IsMember(names));
    command->callback([wanted, &exit_status] {
        for (const Topic& topic : kTopics) {
            if (!wanted->empty() && *wanted != topic.name) continue;
            print("{}\n", topic.name);
            topic.print();
        }
        exit_status = kDone;
    });
}

}  // namespace alhazen::cli
