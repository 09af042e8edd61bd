#pragma once
/// Chooses one of a list of lights by fixed weights.
///
/// Conventions: a light of weight 0 is never chosen; if all weights are 0, none is.
/// Complexity: O(log n). Threads: const functions may be called from many.

#include <cstddef>
#include <vector>

namespace alhazen {

struct ChosenLight {
    std::size_t light = 0;
    double probability = 0;  ///< 0: none
};

class LightChooser {
  public:
    LightChooser() = default;
    explicit LightChooser(const std::vector<double>& weights);

    /// Chooses a light; `choice` in [0, 1).
    [[nodiscard]] ChosenLight choose(double choice) const;
    [[nodiscard]] double probability(std::size_t light) const;
    [[nodiscard]] std::size_t size() const { return sums_.size(); }
    [[nodiscard]] double total() const { return sums_.empty() ? 0.0 : sums_.back(); }

  private:
    std::vector<double> sums_;  ///< [light] cumulative weights, including it
};

}  // namespace alhazen
