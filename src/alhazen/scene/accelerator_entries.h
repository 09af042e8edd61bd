#pragma once
/// Makes entries of the accelerator table; each list of accelerators in a file of its own, because
/// every traversal is compiled for every query.

#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "alhazen/scene/accelerator_table.h"
#include "alhazen/scene/aggregate_of.h"

namespace alhazen {

template <class A>
AcceleratorEntry accelerator_entry() {
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

template <class... A>
std::vector<AcceleratorEntry> entries_of(std::tuple<A...>*) {
    return {accelerator_entry<A>()...};
}

/// In the order of accel/accel_list.h.
[[nodiscard]] std::vector<AcceleratorEntry> bound_accelerators();
[[nodiscard]] std::vector<AcceleratorEntry> cell_accelerators();
[[nodiscard]] std::vector<AcceleratorEntry> direction_accelerators();

}  // namespace alhazen
