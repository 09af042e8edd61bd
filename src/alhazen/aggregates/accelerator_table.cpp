#include "alhazen/aggregates/accelerator_table.h"

#include <utility>

#include "alhazen/aggregates/accelerator_entries.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"

namespace alhazen {
namespace {

std::shared_ptr<const Aggregate> make_wide_bvh(PrimitiveTable table,
                                               const AcceleratorSettings& settings,
                                               const BuildOptions& options) {
    SettingsReader(kDefaultAccelerator, settings).finish();
    return std::make_shared<const WideBvhAggregate>(std::move(table), options);
}

std::vector<AcceleratorEntry> all_entries() {
    std::vector<MakeAggregate> makers{&make_wide_bvh};
    for (auto* more : {&bound_accelerators, &cell_accelerators, &direction_accelerators}) {
        for (const MakeAggregate make : more()) makers.push_back(make);
    }
    std::vector<AcceleratorEntry> entries;
    for (const AcceleratorInfo& info : accelerator_names()) {
        entries.push_back({info, makers[entries.size()]});
    }
    return entries;
}

}  // namespace

std::span<const AcceleratorEntry> accelerator_table() {
    static const std::vector<AcceleratorEntry> entries = all_entries();
    return entries;
}

std::shared_ptr<const Aggregate> make_aggregate(const std::string& accelerator,
                                                PrimitiveTable table, const BuildOptions& options) {
    const AcceleratorChoice choice = parse_accelerator(accelerator);
    const AcceleratorEntry& entry = accelerator_table()[accelerator_index(choice.name)];
    return entry.make(std::move(table), choice.settings, options);
}

}  // namespace alhazen
