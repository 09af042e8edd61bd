#pragma once
/// Times of tracers measured in turn, and their statistics.

#include <functional>
#include <string>
#include <vector>

namespace alhazen::bench {

/// Processor time of this thread, in seconds, which excludes time taken by other programs.
[[nodiscard]] double processor_seconds();

/// Minimum, quartiles and maximum.
struct Spread {
    double min = 0, lower = 0, median = 0, upper = 0, max = 0;
};
/// The quantiles, interpolated. Precondition: `values` is not empty.
[[nodiscard]] Spread spread_of(std::vector<double> values);

struct Contender {
    std::string group;              ///< tracer family: "alhazen", "robust", "fast"
    std::string name;               ///< variant within the group
    std::function<void()> prepare;  ///< before each round, not timed; may be empty
    std::function<void()> trace;
    std::function<std::size_t()> count_hits;  ///< after the first round, not timed
};

struct Measured {
    std::string group, name;
    std::vector<double> rates;  ///< [round] million rays per second
    std::size_t hits = 0;

    [[nodiscard]] Spread spread() const { return spread_of(rates); }
};

/// Runs the tracers in turn, round after round, so that a drift of the machine's speed affects all
/// alike. Each round has an order of its own, drawn with a seed of `set`, the name of its rays. No
/// tracer follows one of its group: the second to trace the same rays in the same tree would find
/// it in the caches and its jumps foreseen. Where only those are left, one of another group runs
/// between them, untimed. The first round warms the caches and is not counted.
[[nodiscard]] std::vector<Measured> measure(const std::string& set,
                                            const std::vector<Contender>& tracers, std::size_t rays,
                                            int rounds);

/// The tracer of a group with the best median; null if there is none. Ignores tracers whose number
/// of hits differs by more than 0.5 % from that of the first in the list: they trace another scene.
[[nodiscard]] const Measured* best_of(const std::vector<Measured>& list, const std::string& group);
[[nodiscard]] const Measured* find(const std::vector<Measured>& list, const std::string& group,
                                   const std::string& name);

/// The quotient a / b for each round, which cancels noise that lasts longer than a round.
[[nodiscard]] Spread ratio_by_round(const Measured& a, const Measured& b);

}  // namespace alhazen::bench
