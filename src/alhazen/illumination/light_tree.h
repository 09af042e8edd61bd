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
/// Complexity: O(n log n) to build, 132 bytes a light; O(depth) for a choice or a probability.
/// Threads: const functions may be called from many.

#include <cstddef>
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
        bool two_sided;
    };
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    /// What a node leads to: a pair of siblings, or a light.
    class Link {
      public:
        Link() = default;
        [[nodiscard]] static Link to_siblings(std::uint32_t pair) { return Link(pair); }
        [[nodiscard]] static Link to_light(std::uint32_t light) { return Link(light | kLight); }

        [[nodiscard]] bool is_leaf() const { return (bits_ & kLight) != 0; }
        [[nodiscard]] std::uint32_t bits() const { return bits_; }
        [[nodiscard]] static Link of_bits(std::uint32_t bits) { return Link(bits); }
        /// The number of the light or of the pair.
        [[nodiscard]] std::uint32_t target() const { return bits_ & ~kLight; }

      private:
        explicit Link(std::uint32_t bits) : bits_(bits) {}
        static constexpr std::uint32_t kLight = 0x80000000u;
        std::uint32_t bits_ = 0;
    };

    /// Two siblings, [sibling]: the numbers that an importance depends on, and what follows.
    struct alignas(64) Siblings {
        double center[3][2];
        double radius2[2];  ///< squared, of the sphere around the box
        float axis[3][2];
        float cosine_spread[2];
        float cosine_reach[2];
        float intensity[2];  ///< negative: that of two-sided lights
        Link links[2];
        std::uint32_t parent;  ///< a node, or kNone

        void set(std::size_t sibling, const Node& node);
    };
    [[nodiscard]] bool empty() const { return empty_; }
    [[nodiscard]] Link root() const { return root_; }
    /// True if each light emits up to a right angle from its normals, as surfaces do.
    [[nodiscard]] bool has_surfaces_only() const { return surfaces_only_; }
    /// Node 2 k + i is sibling i of pair k.
    [[nodiscard]] const std::vector<Siblings>& pairs() const { return pairs_; }

  private:
    friend class LightTreeBuilder;

    bool empty_ = true;
    bool surfaces_only_ = true;
    Link root_;
    std::vector<Siblings> pairs_;
    std::vector<std::uint32_t> leaves_;  ///< [light]: a node, or kNone
};

}  // namespace alhazen
