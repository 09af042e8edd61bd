#pragma once
/// A tree over many lights, with means and bounds of places, axes and intensities: chooses a light
/// by an estimate of what it sends to a point.
///
/// Source: Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
/// Splitting", HPG 2018: orientation cones (section 4.1), the surface area orientation heuristic
/// (4.4).
/// Differs: nodes have four children, two levels of their splits. One light is chosen. Importances
/// are means instead of bounds (light_importance.h). Cones of bins are around the mean axis. Large
/// nodes are split along their longest axis only. The energy of a light is its largest intensity.
/// Conventions: every light that may reach a point has a probability above 0. Leaves hold one
/// light. Nodes are in the frame of the tree: the box of all lights is around its origin, its half
/// diagonal is 1.
/// Complexity: O(n log n) to build, about 70 bytes a light; O(depth) for a choice or a probability.
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
    /// Cosine of the largest angle of emission from a normal; of surfaces 0.
    double cosine_reach = 0;
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

    /// What a child is: a node, or a light.
    class Link {
      public:
        Link() = default;
        [[nodiscard]] static Link to_node(std::uint32_t node) { return Link(node); }
        [[nodiscard]] static Link to_light(std::uint32_t light) { return Link(light | kLight); }

        [[nodiscard]] bool is_leaf() const { return (bits_ & kLight) != 0; }
        [[nodiscard]] std::uint32_t bits() const { return bits_; }
        [[nodiscard]] static Link of_bits(std::uint32_t bits) { return Link(bits); }
        /// The number of the light or of the node.
        [[nodiscard]] std::uint32_t target() const { return bits_ & ~kLight; }

      private:
        explicit Link(std::uint32_t bits) : bits_(bits) {}
        static constexpr std::uint32_t kLight = 0x80000000u;
        std::uint32_t bits_ = 0;
    };

    /// Children of a node.
    static constexpr std::uint32_t kWidth = 4;
    template <class T>
    using OfChildren = T[kWidth];

    /// A node, [child]: the numbers that the importance of a child depends on, and what follows.
    /// Those that it has not have the intensity 0.
    struct alignas(128) Node {
        OfChildren<float> center[3];  ///< mean of the lights by intensity
        OfChildren<float> variance;   ///< about the centre, along one axis; enlarged, never 0
        /// The upper 19 bits of the float of the share of all intensity, negative that of two-sided
        /// lights; the upper 13 bits of the float of the factor s of light_importance.h.
        OfChildren<std::uint32_t> intensity_turn;
        /// x and y of the mean of the axes of emission, in units of 1 / kAxisUnits, 16 bits each.
        OfChildren<std::uint32_t> axis_xy;
        /// z of that mean, 16 bits; the upper half of the float of a squared radius around the
        /// centre, rounded up.
        OfChildren<std::uint32_t> axis_z_radius2;
        OfChildren<Link> links;
    };
    static constexpr float kAxisUnits = 32767.0f;
    static constexpr int kTurnBits = 13;
    static constexpr std::uint32_t kIntensityMask = ~((1u << kTurnBits) - 1);
    /// The cones of emission of the children of a node, [child], around all axes of their lights.
    struct Cones {
        OfChildren<float> axis[3];
        OfChildren<float> cosine;  ///< of the half angle; below -1: all directions
        OfChildren<float> radius;  ///< around the centre
    };
    [[nodiscard]] bool empty() const { return empty_; }
    [[nodiscard]] Link root() const { return root_; }
    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
    /// [node]; empty if all lights are surfaces or emit in all directions.
    [[nodiscard]] const std::vector<Cones>& cones() const { return cones_; }
    /// The origin of the frame of the tree in world space, and its units per unit there.
    [[nodiscard]] const Vec3& origin() const { return origin_; }
    [[nodiscard]] double scale() const { return scale_; }

  private:
    friend class LightTreeBuilder;

    [[nodiscard]] const Cones* cones_of(std::uint32_t node) const {
        return cones_.empty() ? nullptr : &cones_[node];
    }

    bool empty_ = true;
    Link root_;
    Vec3 origin_;
    double scale_ = 1;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> parents_;  ///< [node]: kWidth times its parent, and which child
    std::vector<Cones> cones_;
    std::vector<std::uint32_t> leaves_;  ///< [light]: the same, or kNone
};

}  // namespace alhazen
