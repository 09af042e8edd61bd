#pragma once
/// Every accelerator by name, with its settings: what can be checked and listed without a scene.
/// The accelerators themselves: accel_list.h and the wide BVH.

#include <span>
#include <string>
#include <vector>

#include "alhazen/accel/core/accelerator_settings.h"

namespace alhazen {

struct AcceleratorInfo {
    const char* name;
    const char* description;  ///< one line
    std::vector<SettingDescription> (*settings)();
    /// Throws Error (Usage) for a setting that the accelerator does not have, or a value that it
    /// does not take.
    void (*check)(const AcceleratorSettings& settings);
};

inline constexpr const char* kDefaultAccelerator = "wide_bvh";

/// In the order of accel_list.h, the default one first.
[[nodiscard]] std::span<const AcceleratorInfo> accelerator_names();

/// Throws Error (Usage) when `accelerator` ("NAME" or "NAME:SETTING=VALUE,...") is none, with what
/// is valid.
void check_accelerator(const std::string& accelerator);

/// The position of the name in `accelerator_names`. Throws Error (Usage) with the valid names.
[[nodiscard]] std::size_t accelerator_index(const std::string& name);

}  // namespace alhazen
