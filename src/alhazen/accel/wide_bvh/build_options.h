#pragma once
/// How much work goes into building an accelerator. The hits are the same for all; what changes is
/// how long building and tracing take.

#include <cstdint>
#include <span>
#include <string>

namespace alhazen {

enum class BuildQuality : std::uint8_t {
    Fast,     ///< for what changes from picture to picture: clustering along a space-filling curve
    Default,  ///< binned surface area heuristic
    High,     ///< for what is traced for long: spatial splits, reinsertion
};

struct BuildOptions {
    BuildQuality quality = BuildQuality::Default;
};

struct BuildQualityEntry {
    const char* name;
    const char* description;  ///< one line
    BuildQuality quality;
};

/// In the order of the enumeration.
[[nodiscard]] std::span<const BuildQualityEntry> build_quality_table();
/// The one called `name`. Throws Error(Usage) with the valid names for an unknown one.
[[nodiscard]] BuildQuality find_build_quality(const std::string& name);
[[nodiscard]] const char* name_of(BuildQuality quality);

}  // namespace alhazen
