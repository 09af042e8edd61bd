#pragma once
/// Many lights as a binary tree with bounds of place, direction and intensity: one is chosen by
/// what it may send to a point.
///
/// Source: Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
/// Splitting", HPG 2018: orientation cones (section 4.1), the surface area orientation heuristic
/// (4.4), the importance of a node (5).
/// Differs: no adaptive splitting: one light is chosen. A node whose emitters shine to both sides
/// has the cone of one of the sides. Cones of bins are around the mean axis. Large nodes are split
/// along their longest axis alone. The energy of a light is its largest intensity.
/// Conventions: a light that may send something to a point has a probability above 0. Leaves hold
/// one light.
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
    double intensity = 0;     ///< 0: it is not in the tree
    double cosine_reach = 0;  ///< of the largest angle from a normal into which it shines
};

class LightTree {
  public:
    LightTree() = default;
    explicit LightTree(const std::vector<TreeLight>& lights);

    /// `choice` in [0, 1).
    [[nodiscard]] ChosenLight choose(const LitPoint& at, double choice) const;
    /// With which `choose` gives it.
    [[nodiscard]] double probability(const LitPoint& at, std::size_t light) const;

    struct Node {
        float lo[3], hi[3];  ///< rounded outward
        float axis[3];
        float cosine_spread;  ///< of the cone of normals; -1: all directions
        float cosine_reach;
        float intensity;
        std::uint32_t parent;   ///< kNone: the root
        std::uint32_t content;  ///< the first of two children; of a leaf the light
        bool leaf, two_sided;
    };
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

  private:
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaves_;  ///< [light], or kNone
};

}  // namespace alhazen
