#pragma once
/// Statistics of a render, as JSON (docs/statistics.md).

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "alhazen/session/load.h"
#include "alhazen/session/render.h"

namespace alhazen {

[[nodiscard]] const char* version();

/// Largest resident set of this process so far, bytes.
[[nodiscard]] std::uint64_t peak_rss_bytes();

[[nodiscard]] nlohmann::ordered_json statistics(const std::string& scene_name,
                                                const LoadedScene& loaded,
                                                const RenderOptions& options,
                                                const RenderResult& result, double write_seconds);

}  // namespace alhazen
