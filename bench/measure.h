#pragma once
/// Times of tracers that take turns, and what is said about them.

#include <functional>
#include <string>
#include <vector>

namespace alhazen::bench {

/// Seconds that this thread has computed: what other programs take of the processor does not count.
[[nodiscard]] double processor_seconds();

/// Least, quartiles and greatest of some numbers.
struct Spread {
    double min = 0, lower = 0, median = 0, upper = 0, max = 0;
};
/// Quantiles are interpolated; `values` is not empty.
[[nodiscard]] Spread spread_of(std::vector<double> values);

struct Contender {
    std::string group;              ///< who: "alhazen", "robust", "fast"
    std::string name;               ///< which way within the group
    std::function<void()> prepare;  ///< before each round, not timed; may be empty
    std::function<std::size_t()> trace;
    /// After the last round, not timed: how many rays hit. Empty: what `trace` gave.
    std::function<std::size_t()> count_hits;
};

struct Measured {
    std::string group, name;
    std::vector<double> rates;  ///< [round] million rays per second
    std::size_t hits = 0;

    [[nodiscard]] Spread spread() const { return spread_of(rates); }
};

/// Tracers in turn, round after round, so that a drift of the machine's speed meets them all alike.
/// The first round warms the caches and is not counted.
[[nodiscard]] std::vector<Measured> measure(const std::vector<Contender>& tracers, std::size_t rays,
                                            int rounds);

/// The one of a group with the best median; null when there is none. One whose number of hits is
/// more than 0.5 % off that of the first of the list does not count: it traces something else.
[[nodiscard]] const Measured* best_of(const std::vector<Measured>& list, const std::string& group);
[[nodiscard]] const Measured* find(const std::vector<Measured>& list, const std::string& group,
                                   const std::string& name);

/// Ratios a / b round by round: noise that lasts longer than a round falls out.
[[nodiscard]] Spread ratio_by_round(const Measured& a, const Measured& b);

}  // namespace alhazen::bench
