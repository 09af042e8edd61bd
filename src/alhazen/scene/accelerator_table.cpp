#include "alhazen/scene/accelerator_table.h"

#include <array>
#include <utility>

#include "alhazen/accel/accel_list.h"
#include "alhazen/base/error.h"
#include "alhazen/scene/aggregate_of.h"
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

template <class A>
AcceleratorEntry entry() {
    return {A::kName, A::kDescription,
            [] {
                const AcceleratorSettings none;
                SettingsReader reader(A::kName, none);
                (void)A::configure(reader);
                return reader.described();
            },
            [](PrimitiveTable table, const AcceleratorSettings& settings,
               const BuildOptions&) -> std::shared_ptr<const Aggregate> {
                SettingsReader reader(A::kName, settings);
                const typename A::Config config = A::configure(reader);
                reader.finish();
                return std::make_shared<const AggregateOf<A>>(std::move(table), config);
            }};
}

/// The wide BVH and all scalar accelerators.
template <class... A>
auto make_entries(std::tuple<A...>*) {
    return std::array{wide_bvh_entry(), entry<A>()...};
}

}  // namespace

std::span<const AcceleratorEntry> accelerator_table() {
    static const auto entries = make_entries(static_cast<ScalarAccelerators*>(nullptr));
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
