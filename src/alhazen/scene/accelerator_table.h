#pragma once
/// Every accelerator by name.

#include <memory>
#include <span>
#include <string>

#include "alhazen/accel/wide_bvh/build_options.h"
#include "alhazen/scene/aggregate.h"
#include "alhazen/scene/primitive_table.h"

namespace alhazen {

struct AcceleratorEntry {
    const char* name;
    const char* description;  ///< one line
    std::shared_ptr<const Aggregate> (*make)(PrimitiveTable table, const BuildOptions& options);
};

/// The default one first.
[[nodiscard]] std::span<const AcceleratorEntry> accelerator_table();

inline constexpr const char* kDefaultAccelerator = "wide_bvh";

/// Throws Error (Usage) with the valid names for an unknown one.
void check_accelerator_name(const std::string& name);

/// Builds the accelerator over a finished table. Throws Error(Usage) with the valid names for an
/// unknown one. Accelerators that know no qualities are built as they are.
[[nodiscard]] std::shared_ptr<const Aggregate> make_aggregate(const std::string& accelerator_name,
                                                              PrimitiveTable table,
                                                              const BuildOptions& options = {});

}  // namespace alhazen
