#pragma once
/// The accelerators by name, with their settings, for checks and listings without a scene. The
/// accelerators themselves are in accel_list.h and wide_bvh/.

#include <span>
#include <string>
#include <vector>

#include "alhazen/accel/core/accelerator_settings.h"

namespace alhazen {

struct AcceleratorInfo {
    const char* name;
    const char* description;  ///< one line
    std::vector<SettingDescription> (*settings)();
    /// Throws Error (Usage) for an unknown setting or an invalid value.
    void (*check)(const AcceleratorSettings& settings);
};

inline constexpr const char* kDefaultAccelerator = "wide_bvh";

/// In the order of accel_list.h, preceded by the default.
[[nodiscard]] std::span<const AcceleratorInfo> accelerator_names();

/// Throws Error (Usage) with the valid choices if `accelerator` ("NAME" or
/// "NAME:SETTING=VALUE,...") is invalid.
void check_accelerator(const std::string& accelerator);

/// The index of the name in `accelerator_names`. Throws Error (Usage) with the valid names.
[[nodiscard]] std::size_t accelerator_index(const std::string& name);

}  // namespace alhazen
