#pragma once
/// A BSP tree: every node divides its convex cell by an arbitrary plane, chosen by the surface area
/// heuristic over the exact cells.
///
/// Source: Fuchs, Kedem and Naylor, "On Visible Surface Generation by A Priori Tree Structures",
/// SIGGRAPH 1980 (the tree); Ize, Wald and Parker, "Ray Tracing with the BSP Tree", RT 2008
/// (`planes=polygons`: planes of flat polygons and through their edges, exact areas of cells, a
/// cheaper step at axis-aligned planes); Kammaje and Mora, "A Study of Restricted BSP Trees for Ray
/// Tracing", RT 2007 (`planes=directions7` or `directions13`: few directions, prepared once per
/// ray, like Kay and Kajiya's slabs).
/// Differs: nodes of many primitives weigh a fixed number of planes, chosen by rank among those of
/// Differs: nodes of many primitives evaluate a fixed number of planes, selected by rank among
/// those of evenly selected primitives; the plane of a polygon is placed next to it, so that the
/// polygon lies on one side. Primitives that are not flat polygons are not clipped, only removed
/// from cells that they do not overlap. Rays from so far away that rounding could make them miss a
/// cell are tested against all primitives.
/// Complexity: O(n log n) to build, with a large constant factor.

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/accel/bounds/bounds.h"
#include "alhazen/accel/cells/mailbox.h"
#include "alhazen/accel/cells/plane_walk.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/accelerator_settings.h"
#include "alhazen/accel/core/padded_box.h"

namespace alhazen {

class Bsp {
  public:
    static constexpr const char* kName = "bsp";
    static constexpr const char* kDescription =
        "planes of any direction by the surface area heuristic";
    static constexpr bool kVisitsRepeatedly = true;
    struct Config {
        int directions = 13;         ///< 3, 7 or 13 common directions of candidate planes
        bool polygons = false;       ///< also use planes of flat polygons
        int candidates = 16;         ///< planes per direction; polygons that contribute planes
        double axis_cost = 15;       ///< cost of a step at an axis-aligned plane
        double traversal_cost = 25;  ///< cost of a step at any other plane
        double test_cost = 20;       ///< cost of a primitive
        double empty_factor =
            0.8;            ///< cost factor of an axis-aligned split that cuts off empty space
        int max_depth = 0;  ///< 0: 8 + 1.3 log2 n
        bool mailbox = true;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    /// Throws Error(Resource) for more than 2^32 entries in the leaves.
    [[nodiscard]] static Bsp build(const BoundsSource& source, const Config& config);

    /// A leaf has `normal` kLeaf and the primitives entries[index .. index + count); an inner node
    /// divides by normals[normal] . p = offset, its lower child follows it, the upper one is at
    /// `index`.
    struct Node {
        static constexpr std::uint32_t kLeaf = 0xFFFFFFFFu;
        double offset = 0;
        std::uint32_t index = 0;
        std::uint32_t count = 0;
        std::uint32_t normal = kLeaf;

        [[nodiscard]] bool is_leaf() const { return normal == kLeaf; }
    };
    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
    /// Unit vectors; the axes first.
    [[nodiscard]] const std::vector<Vec3>& normals() const { return normals_; }
    [[nodiscard]] const std::vector<std::uint32_t>& entries() const { return entries_; }
    [[nodiscard]] const Box3& box() const { return space_.box; }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const;

    [[nodiscard]] std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(Node) + normals_.capacity() * sizeof(Vec3) +
               entries_.capacity() * sizeof(std::uint32_t);
    }

  private:
    friend class BspBuilder;
    /// Position and inverse speed of a ray along a direction.
    struct Along {
        double place, inverse;
    };
    [[nodiscard]] static Along along(const Vec3& normal, const Ray& ray) {
        return {dot(normal, ray.origin), 1.0 / dot(normal, ray.direction)};
    }

    Config config_;
    PaddedBox space_;
    std::uint32_t primitives_ = 0;
    std::vector<Node> nodes_;
    std::vector<Vec3> normals_;
    std::vector<std::uint32_t> entries_;
};

template <class Visitor, class Stats>
void Bsp::traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
    if (nodes_.empty()) return;
    if (!space_.covers(ray)) return visit_all(primitives_, visitor);
    const RaySpan span(space_.box, ray, visitor.t_max());
    if (span.empty()) return;
    std::array<Along, 13> prepared{};
    const auto directions = static_cast<std::uint32_t>(config_.directions);
    for (std::uint32_t k = 0; k < directions; ++k) prepared[k] = along(normals_[k], ray);

    Mailbox mailbox;
    const auto from_plane = [&](const Node& node) {
        const Along a =
            node.normal < directions ? prepared[node.normal] : along(normals_[node.normal], ray);
        return FromPlane{a.place - node.offset, a.inverse};
    };
    const auto test_leaf = [&](std::uint32_t number) {
        const Node& leaf = nodes_[number];
        const std::span entries(entries_.data() + leaf.index, leaf.count);
        return visit_entries(entries, config_.mailbox, mailbox, visitor, stats);
    };
    walk_through_planes(nodes_, span, 0.5 * space_.pad, from_plane, test_leaf, visitor, stats);
}
static_assert(Accelerator<Bsp>);

}  // namespace alhazen
