#pragma once
/// Factories of aggregates for the accelerators of accel/accel_list.h. Each list of accelerators
/// has its own source file, because every traversal is compiled for every query.

#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/aggregate_of.h"

namespace alhazen {

template <class A>
std::shared_ptr<const Aggregate> make_aggregate_of(PrimitiveTable table,
                                                   const AcceleratorSettings& settings,
                                                   const BuildOptions&) {
    SettingsReader reader(A::kName, settings);
    const typename A::Config config = A::configure(reader);
    reader.finish();
    return std::make_shared<const AggregateOf<A>>(std::move(table), config);
}

template <class... A>
std::vector<MakeAggregate> makers_of(std::tuple<A...>*) {
    return {&make_aggregate_of<A>...};
}

/// The factories of each list, in the order of accel/accel_list.h.
[[nodiscard]] std::vector<MakeAggregate> bound_accelerators();
[[nodiscard]] std::vector<MakeAggregate> cell_accelerators();
[[nodiscard]] std::vector<MakeAggregate> direction_accelerators();

}  // namespace alhazen
