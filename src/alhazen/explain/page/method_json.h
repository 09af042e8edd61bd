#pragma once
/// Cones, beams, patches and paths of an explanation as JSON (docs/guide/explain.md lists the
/// fields).

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "alhazen/explain/beams/beam_explanation.h"
#include "alhazen/explain/cones/cone_explanation.h"
#include "alhazen/explain/patches/patch_subdivision.h"
#include "alhazen/renderers/core/path_record.h"
#include "alhazen/solids/vector_json.h"

namespace alhazen {

inline nlohmann::ordered_json color_json(const Rgb& c) {
    return {c.r, c.g, c.b};
}
/// Rounds to six digits, for data that are only drawn.
inline double rounded(double x) {
    return std::isfinite(x) ? std::stod(fmt::format("{:.6g}", x)) : 0.0;
}

[[nodiscard]] nlohmann::ordered_json cones_json(const ConeExplanation& cones,
                                                const std::vector<std::string>& lights);
[[nodiscard]] nlohmann::ordered_json patches_json(const std::vector<PatchSubdivision>& patches);
/// `lights`: [light] name.
[[nodiscard]] nlohmann::ordered_json beams_json(const BeamExplanation& beams,
                                                const std::vector<std::string>& lights);
/// `part_names`, `material_names`: those of the Explanation.
[[nodiscard]] nlohmann::ordered_json path_json(const PathRecord& path,
                                               const std::vector<std::string>& part_names,
                                               const std::vector<std::string>& material_names);

}  // namespace alhazen
