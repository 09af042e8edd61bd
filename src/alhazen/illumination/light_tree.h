#pragma once
/// A binary tree over many lights, with bounds of position, direction and intensity: chooses a
/// light by an estimate of what it sends to a point.
///
/// Source: Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
/// Splitting", HPG 2018: orientation cones (section 4.1), the surface area orientation heuristic
/// (4.4), the importance of a node (5).
/// Differs: no adaptive splitting: one light is chosen. A node of two-sided emitters has the cone
/// of one side. Cones of bins are around the mean axis. Large nodes are split along their longest
/// axis only. The energy of a light is its largest intensity.
/// Conventions: every light that may reach a point has a probability above 0. Leaves hold one
/// light.
/// Complexity: O(n log n) to build, 128 bytes a light; O(depth) for a choice or a probability.
/// Threads: const functions may be called from many.

#include <cstdint>
#include <vector>

#include "alhazen/illumination/emitter.h"
#include "alhazen/illumination/light_chooser.h"
#include "alhazen/illumination/lit_point.h"

namespace alhazen {

struct TreeLight {
    EmitterBounds bounds;
    bool two_sided = false;
    double intensity = 0;     ///< 0: not in the tree
    double cosine_reach = 0;  ///< cosine of the largest angle of emission from a normal
};

class LightTree {
  public:
    LightTree() = default;
    explicit LightTree(const std::vector<TreeLight>& lights);

    /// Chooses a light for a point; `choice` in [0, 1).
    [[nodiscard]] ChosenLight choose(const LitPoint& at, double choice) const;
    /// The probability of `choose` for a light.
    [[nodiscard]] double probability(const LitPoint& at, std::size_t light) const;

    struct Node {
        float lo[3], hi[3];  ///< rounded outward
        float axis[3];
        float cosine_spread;  ///< as in EmitterBounds
        float cosine_reach;
        float intensity;
        std::uint32_t parent;   ///< kNone: the root
        std::uint32_t content;  ///< the first of two successive children; of a leaf the light
        bool leaf, two_sided;
    };
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

  private:
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaves_;  ///< [light], or kNone
};

}  // namespace alhazen
