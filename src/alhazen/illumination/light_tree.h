#pragma once
/// A binary tree over many lights, with bounds of position, direction and intensity: chooses a
/// light by an estimate of what it sends to a point.
///
/// Source: Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
/// Splitting", HPG 2018: orientation cones (section 4.1), the surface area orientation heuristic
/// (4.4).
/// Differs: no adaptive splitting: one light is chosen. Importances are means instead of bounds
/// (light_importance.h). Cones of bins are around the mean axis. Large nodes are split along their
/// longest axis only. The energy of a light is its largest intensity.
/// Conventions: every light that may reach a point has a probability above 0. Leaves hold one
/// light. Nodes are in the frame of the tree: the box of all lights is around its origin, its half
/// diagonal is 1.
/// Complexity: O(n log n) to build, 76 bytes a light; O(depth) for a choice or a probability.
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
    double intensity = 0;  ///< 0: not in the tree
    double cosine_reach =
        0;  ///< cosine of the largest angle of emission from a normal; surfaces: 0
};

class LightTree {
  public:
    LightTree() = default;
    explicit LightTree(const std::vector<TreeLight>& lights);

    /// Chooses a light for a point; `choice` in [0, 1).
    [[nodiscard]] ChosenLight choose(const LitPoint& at, double choice) const;
    /// The probability of `choose` for a light.
    [[nodiscard]] double probability(const LitPoint& at, std::size_t light) const;

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
        float center[3][2];  ///< mean of the lights by intensity
        float variance[2];   ///< about the centre, along one axis; enlarged, never 0
        float intensity[2];  ///< share of all; negative: that of two-sided lights
        /// x and y of the mean of the axes of emission, in units of 1 / kAxisUnits, 16 bits each.
        std::uint32_t axis_xy[2];
        /// z of that mean, 16 bits; the upper half of the float of a squared radius around the
        /// centre, rounded up.
        std::uint32_t axis_z_radius2[2];
        Link links[2];
    };
    static constexpr float kAxisUnits = 32767.0f;
    /// The cones of emission of two siblings, [sibling], around all axes of their lights.
    struct Cones {
        float axis[3][2];
        float cosine[2];  ///< of the half angle; below -1: all directions
        float radius[2];  ///< around the centre
    };
    [[nodiscard]] bool empty() const { return empty_; }
    [[nodiscard]] Link root() const { return root_; }
    /// Node 2 k + i is sibling i of pair k.
    [[nodiscard]] const std::vector<Siblings>& pairs() const { return pairs_; }
    /// [pair]; empty if all lights are surfaces or emit in all directions.
    [[nodiscard]] const std::vector<Cones>& cones() const { return cones_; }
    /// The origin of the frame of the tree in world space, and its units per unit there.
    [[nodiscard]] const Vec3& origin() const { return origin_; }
    [[nodiscard]] double scale() const { return scale_; }

  private:
    friend class LightTreeBuilder;

    [[nodiscard]] const Cones* cones_of(std::uint32_t pair) const {
        return cones_.empty() ? nullptr : &cones_[pair];
    }

    bool empty_ = true;
    Link root_;
    Vec3 origin_;
    double scale_ = 1;
    std::vector<Siblings> pairs_;
    std::vector<std::uint32_t> parents_;  ///< [pair]: a node, or kNone
    std::vector<Cones> cones_;
    std::vector<std::uint32_t> leaves_;  ///< [light]: a node, or kNone
};

}  // namespace alhazen
