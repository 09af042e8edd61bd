#include "alhazen/scene/accelerator_table.h"

#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/scene/accelerator_entries.h"
#include "alhazen/scene/wide_bvh_aggregate.h"

namespace alhazen {
namespace {

AcceleratorEntry wide_bvh_entry() {
    return {WideBvhAggregate::kName, WideBvhAggregate::kDescription,
            [] { return std::vector<SettingDescription>{}; },
            [](PrimitiveTable table, const AcceleratorSettings& settings,
               const BuildOptions& options) -> std::shared_ptr<const Aggregate> {
                SettingsReader(WideBvhAggregate::kName, settings).finish();
                return std::make_shared<const WideBvhAggregate>(std::move(table), options);
            }};
}

/// The wide BVH and all scalar accelerators.
std::vector<AcceleratorEntry> all_entries() {
    std::vector<AcceleratorEntry> entries{wide_bvh_entry()};
    for (auto* more : {&bound_accelerators, &cell_accelerators, &direction_accelerators}) {
        for (const AcceleratorEntry& entry : more()) entries.push_back(entry);
    }
    return entries;
}

}  // namespace

std::span<const AcceleratorEntry> accelerator_table() {
    static const std::vector<AcceleratorEntry> entries = all_entries();
    return entries;
}

namespace {

const AcceleratorEntry& find_accelerator(const std::string& name) {
    std::string names;
    for (const AcceleratorEntry& entry : accelerator_table()) {
        if (name == entry.name) return entry;
        names += names.empty() ? "" : ", ";
        names += entry.name;
    }
    throw Error(ErrorKind::Usage, "no accelerator '" + name + "'; the valid names are: " + names);
}

}  // namespace

void check_accelerator(const std::string& accelerator) {
    const AcceleratorChoice choice = parse_accelerator(accelerator);
    // Of nothing: whatever can be wrong with settings is found without a scene.
    PrimitiveTable nothing;
    nothing.finish();
    (void)find_accelerator(choice.name).make(std::move(nothing), choice.settings, {});
}

std::shared_ptr<const Aggregate> make_aggregate(const std::string& accelerator,
                                                PrimitiveTable table, const BuildOptions& options) {
    const AcceleratorChoice choice = parse_accelerator(accelerator);
    return find_accelerator(choice.name).make(std::move(table), choice.settings, options);
}

}  // namespace alhazen
