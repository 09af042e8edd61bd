#pragma once
/// Results of the kernel benchmark as text, JSON and Markdown tables.

#include <nlohmann/json.hpp>
#include <string>

#include "measure.h"
#include "our_tracer.h"

namespace alhazen::bench {

inline constexpr const char* kOurs = "alhazen";
inline constexpr const char* kOursFast = "alhazen fast";
inline constexpr const char* kOursMasked = "alhazen masked";
inline constexpr const char* kRobust = "embree robust";
inline constexpr const char* kFast = "embree fast";

struct SetResult {
    std::string rays;
    std::size_t count = 0;
    WorkPerRay work;
    std::vector<Measured> tracers;
};

struct SceneResult {
    std::string name, contents;
    std::vector<SetResult> sets;
};

/// Instructions per ray.
struct Counted {
    std::string group, name;
    std::size_t hits = 0;
    double per_ray = 0;
};

struct InstructionResult {
    std::string rays;
    std::size_t count = 0;
    std::vector<Counted> tracers;
};

struct InstructionScene {
    std::string name, contents;
    std::vector<InstructionResult> sets;
};

/// Settings of a run, for the head of a table.
struct RunFacts {
    std::string command;
    std::string machine;  ///< processor, cores, versions
    int rounds = 0;
};
[[nodiscard]] RunFacts run_facts(int argc, char** argv, int rounds);

/// One line of text for each tracer of the set.
[[nodiscard]] std::string as_text(const SetResult& set);
[[nodiscard]] nlohmann::ordered_json as_json(const RunFacts& facts,
                                             const std::vector<SceneResult>& scenes);
/// Tables of medians and ratios, their spread, the cost of masks if measured, and the numbers of
/// hits if they differ.
[[nodiscard]] std::string as_markdown(const RunFacts& facts,
                                      const std::vector<SceneResult>& scenes);

[[nodiscard]] std::string as_text(const InstructionResult& set);
/// A table of ours and of the peer's robust calls.
[[nodiscard]] std::string as_markdown(const RunFacts& facts,
                                      const std::vector<InstructionScene>& scenes);

}  // namespace alhazen::bench
