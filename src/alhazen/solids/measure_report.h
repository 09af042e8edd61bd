#pragma once
/// Results of `alhazen measure` as JSON and text.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/solids/clearance.h"
#include "alhazen/solids/solid_measures.h"
#include "alhazen/solids/solid_scene.h"

namespace alhazen {

struct SolidReport {
    SolidId solid{};
    std::string name;
    SolidMeasures measures;
    std::vector<std::optional<double>> densities;  ///< of its materials; see SolidScene
    std::optional<SectionArea> section;
    double seconds = 0;

    /// The only density of its materials, if there is only one.
    [[nodiscard]] std::optional<double> density() const {
        return densities.size() == 1 ? densities.front() : std::nullopt;
    }
    /// True if all checks passed: crossings are paired, directions and areas agree, numbers are in
    /// range.
    [[nodiscard]] bool holds() const;
};

struct PairReport {
    SolidId a{}, b{};
    std::string name_a, name_b;
    std::optional<SolidMeasures> overlap;
    std::optional<Clearance> clearance;
};

struct MeasureReport {
    std::vector<SolidReport> solids;
    std::vector<PairReport> pairs;
    std::uint64_t open_surfaces = 0;
    std::vector<std::string> open_meshes;  ///< which edges are open; see SolidScene

    [[nodiscard]] bool holds() const;
};

[[nodiscard]] nlohmann::ordered_json measure_json(const MeasureReport& report);
[[nodiscard]] std::string measure_text(const MeasureReport& report);

}  // namespace alhazen
