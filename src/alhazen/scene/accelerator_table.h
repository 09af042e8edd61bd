#pragma once
/// Every accelerator by name.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alhazen/accel/accelerator_settings.h"
#include "alhazen/accel/wide_bvh/build_options.h"
#include "alhazen/scene/aggregate.h"
#include "alhazen/scene/primitive_table.h"

namespace alhazen {

struct AcceleratorEntry {
    const char* name;
    const char* description;  ///< one line
    std::vector<SettingDescription> (*settings)();
    /// Throws Error(Usage) for settings it does not have.
    std::shared_ptr<const Aggregate> (*make)(PrimitiveTable table,
                                             const AcceleratorSettings& settings,
                                             const BuildOptions& options);
};

/// The default one first.
[[nodiscard]] std::span<const AcceleratorEntry> accelerator_table();

inline constexpr const char* kDefaultAccelerator = "wide_bvh";

/// Throws Error (Usage) when `accelerator` ("NAME" or "NAME:SETTING=VALUE,...") is none, with what
/// is valid.
void check_accelerator(const std::string& accelerator);

/// Builds the accelerator ("NAME" or "NAME:SETTING=VALUE,...") over a finished table. Throws as
/// `check_accelerator` does. Accelerators that know no qualities are built as they are.
[[nodiscard]] std::shared_ptr<const Aggregate> make_aggregate(const std::string& accelerator,
                                                              PrimitiveTable table,
                                                              const BuildOptions& options = {});

}  // namespace alhazen
