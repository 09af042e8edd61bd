#include "alhazen/scene/accelerator_table.h"

#include <array>
#include <utility>

#include "alhazen/accel/accel_list.h"
#include "alhazen/base/error.h"
#include "alhazen/scene/aggregate_of.h"
#include "alhazen/scene/wide_bvh_aggregate.h"

namespace alhazen {
namespace {

template <class A>
std::shared_ptr<const Aggregate> make(PrimitiveTable table, const BuildOptions& options) {
    if constexpr (std::is_constructible_v<A, PrimitiveTable, const BuildOptions&>) {
        return std::make_shared<const A>(std::move(table), options);
    } else {
        return std::make_shared<const A>(std::move(table));
    }
}

/// Entries of the wide BVH and of all scalar accelerators.
template <class... A>
constexpr auto entries(std::tuple<A...>*) {
    return std::array{AcceleratorEntry{WideBvhAggregate::kName, WideBvhAggregate::kDescription,
                                       &make<WideBvhAggregate>},
                      AcceleratorEntry{A::kName, A::kDescription, &make<AggregateOf<A>>}...};
}

constexpr auto kEntries = entries(static_cast<ScalarAccelerators*>(nullptr));

}  // namespace

std::span<const AcceleratorEntry> accelerator_table() {
    return kEntries;
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

void check_accelerator_name(const std::string& name) {
    (void)find_accelerator(name);
}

std::shared_ptr<const Aggregate> make_aggregate(const std::string& accelerator_name,
                                                PrimitiveTable table, const BuildOptions& options) {
    return find_accelerator(accelerator_name).make(std::move(table), options);
}

}  // namespace alhazen
