#pragma once
/// Accelerators by name: the table of accel/accelerator_names.h with a factory for each.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alhazen/accel/accelerator_names.h"
#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// Builds an aggregate. Throws Error (Usage) for unknown settings of the accelerator.
using MakeAggregate = std::shared_ptr<const Aggregate> (*)(PrimitiveTable table,
                                                           const AcceleratorSettings& settings,
                                                           const BuildOptions& options);

struct AcceleratorEntry : AcceleratorInfo {
    MakeAggregate make;
};

/// All accelerators, in the order of `accelerator_names`.
[[nodiscard]] std::span<const AcceleratorEntry> accelerator_table();

/// Builds the accelerator ("NAME" or "NAME:SETTING=VALUE,...") over a finished table. Throws as
/// `check_accelerator` does. Build options apply to the wide BVH only.
[[nodiscard]] std::shared_ptr<const Aggregate> make_aggregate(const std::string& accelerator,
                                                              PrimitiveTable table,
                                                              const BuildOptions& options = {});

}  // namespace alhazen
