#pragma once
/// Photons in a left-balanced k-d tree, for nearest-neighbour searches.
///
/// Source: Bentley, "Multidimensional Binary Search Trees Used for Associative Searching", CACM
/// 18(9), 1975; Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001, section 6 (left
/// balanced, in the order of a heap, split across the longest side).
/// Differs: subtrees of 16 photons and more have bounding boxes: a plane alone tells nothing of
/// photons that coincide, or lie on a line or a plane beside the point.
/// Conventions: node i has the children 2 i + 1 and 2 i + 2; no pointers. Ties of coordinates are
/// broken by the earlier photon, ties of distances by the lower node: the tree and its results
/// depend only on the list of photons, and a search is fast where photons coincide.
/// Complexity: build O(n log n), 8 bytes per photon in addition to the photons; a search O(k + log
/// n) in the usual case, O(k log n) among photons that coincide and have the same normal. Threads:
/// const functions may be called concurrently.

#include <algorithm>
#include <compare>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/renderers/photons/photon.h"

namespace alhazen {

/// Statistics policy of a search, which counts nothing.
struct NoSearchStats {
    void visit() {}
};

class PhotonTree {
  public:
    /// Memory per photon during construction: the photon, its indices and axis, and its share of
    /// the boxes.
    static constexpr std::size_t kBytesOfPhoton = sizeof(Photon) + 12;

    PhotonTree() = default;
    /// At most 2^32 - 1 photons, of finite positions. Builds with the threads of the caller's
    /// ThreadLimit.
    explicit PhotonTree(std::vector<Photon> photons);

    [[nodiscard]] std::span<const Photon> photons() const { return photons_; }  ///< [node]
    /// Axis of the node's splitting plane: 0, 1 or 2.
    [[nodiscard]] int axis(std::size_t node) const { return axes_[node] & kAxis; }

    struct Near {
        double squared = 0;  ///< squared distance
        std::uint32_t node = 0;
        friend auto operator<=>(const Near&, const Near&) = default;
    };
    /// Sets `found` to the `count` nearest photons within the square root of `squared` that
    /// `accept` selects, by their normals alone: a heap, farthest first. `count` must be positive.
    /// `stats.visit()` is called for each node that is visited.
    template <class Accept, class Stats = NoSearchStats>
    void nearest(const Vec3& point, std::size_t count, double squared, const Accept& accept,
                 std::vector<Near>& found, Stats&& stats = {}) const {
        found.clear();
        Near farthest{squared, kLastNode};
        search(0, point, count, farthest, accept, found, stats);
    }

    /// The same photons as `nearest`, in traversal order, which depends only on the point; the
    /// first is the farthest if there are `count`. Fast if `guess` is near the squared distance of
    /// the farthest, and for large counts; the result is independent of it.
    template <class Accept, class Stats = NoSearchStats>
    void nearest(const Vec3& point, std::size_t count, double squared, double guess,
                 const Accept& accept, std::vector<Near>& found, Stats&& stats = {}) const {
        constexpr double kGrowth = 3.0;
        double within = guess > 0.0 ? std::min(guess, squared) : squared;
        while (true) {
            found.clear();
            walk(point, count, within, accept, found, stats);
            if (found.size() >= count || !(within < squared)) break;
            within = std::min(kGrowth * within, squared);
        }
        if (found.size() < count) return;
        keep_nearest(count, found);
        std::iter_swap(found.begin(), std::max_element(found.begin(), found.end()));
    }

  private:
    static constexpr std::uint32_t kLastNode = std::numeric_limits<std::uint32_t>::max();
    /// Parts of `axes_`: the axis; whether all photons of the subtree have the same normal.
    static constexpr std::uint8_t kAxis = 3, kAlike = 4;
    /// Nodes below 1 / kBoxed of their number have boxes: subtrees of at least kBoxed photons.
    static constexpr std::size_t kBoxed = 16;

    /// At most the squared distance of any photon in the box, as it is computed: rounding is
    /// monotonic.
    [[nodiscard]] static double least_squared(const Box3& box, const Vec3& point) {
        const Vec3 below = box.lo - point, above = point - box.hi;
        return length_squared({std::max({below.x, above.x, 0.0}), std::max({below.y, above.y, 0.0}),
                               std::max({below.z, above.z, 0.0})});
    }

    /// Keeps the `count` nearest, in their order.
    static void keep_nearest(std::size_t count, std::vector<Near>& found);

    /// Appends photons within the square root of `squared`, among them the `count` nearest.
    template <class Accept, class Stats>
    void walk(const Vec3& point, std::size_t count, double squared, const Accept& accept,
              std::vector<Near>& found, Stats& stats) const {
        constexpr std::size_t kTimes = 4, kMostLevels = 33;
        std::array<std::uint32_t, kMostLevels> waiting;
        std::size_t levels = 0;
        const std::size_t size = photons_.size();
        Near farthest{squared, kLastNode};
        if (size > 0) waiting[levels++] = 0;
        while (levels > 0) {
            std::size_t node = waiting[--levels];
            while (node < size && is_wanted(0.0, node, farthest)) {
                stats.visit();
                if (!may_hold(node, point, farthest, accept)) break;
                const Photon& photon = photons_[node];
                const Vec3 apart = photon.point() - point;
                const Near near{length_squared(apart), static_cast<std::uint32_t>(node)};
                if (near <= farthest && accept(photon)) {
                    found.push_back(near);
                    if (found.size() > kTimes * count) {
                        keep_nearest(count, found);
                        farthest = *std::max_element(found.begin(), found.end());
                    }
                }
                const std::size_t left = 2 * node + 1;
                if (left >= size) break;
                const double to_plane = -apart[axis(node)];
                const std::size_t near_side = to_plane < 0.0 ? left : left + 1;
                const std::size_t far_side = 2 * left + 1 - near_side;
                if (far_side < size && is_wanted(to_plane * to_plane, far_side, farthest)) {
                    waiting[levels++] = static_cast<std::uint32_t>(far_side);
                }
                node = near_side;
            }
        }
    }

    void build(std::span<std::uint32_t> order, std::size_t node, std::vector<std::uint32_t>& nodes);
    void mark_alike();

    /// Whether a subtree may hold photons up to `farthest`: its nodes are `root` and higher ones,
    /// whose squared distances are at least `squared`.
    [[nodiscard]] static bool is_wanted(double squared, std::size_t root, const Near& farthest) {
        return Near{squared, static_cast<std::uint32_t>(root)} <= farthest;
    }

    /// Whether a subtree with a box may hold accepted photons up to `farthest`; true of others.
    template <class Accept>
    [[nodiscard]] bool may_hold(std::size_t node, const Vec3& point, const Near& farthest,
                                const Accept& accept) const {
        if (node >= boxes_.size()) return true;
        if (!is_wanted(least_squared(boxes_[node], point), node, farthest)) return false;
        return (axes_[node] & kAlike) == 0 || accept(photons_[node]);
    }

    template <class Accept, class Stats>
    void search(std::size_t node, const Vec3& point, std::size_t count, Near& farthest,
                const Accept& accept, std::vector<Near>& found, Stats& stats) const {
        if (node >= photons_.size() || !is_wanted(0.0, node, farthest)) return;
        stats.visit();
        if (!may_hold(node, point, farthest, accept)) return;
        const Photon& photon = photons_[node];
        const Vec3 apart = photon.point() - point;
        if (2 * node + 1 < photons_.size()) {
            const double to_plane = -apart[axis(node)];
            const std::size_t far = to_plane < 0.0 ? 1 : 0, far_side = 2 * node + 1 + far;
            search(2 * node + 2 - far, point, count, farthest, accept, found, stats);
            if (is_wanted(to_plane * to_plane, far_side, farthest)) {
                search(far_side, point, count, farthest, accept, found, stats);
            }
        }
        const Near near{length_squared(apart), static_cast<std::uint32_t>(node)};
        if (!(near <= farthest) || !accept(photon)) return;
        if (found.size() == count) {
            std::pop_heap(found.begin(), found.end());
            found.back() = near;
        } else {
            found.push_back(near);
        }
        std::push_heap(found.begin(), found.end());
        if (found.size() == count) farthest = found.front();
    }

    std::vector<Photon> photons_;
    std::vector<std::uint8_t> axes_;  ///< [node] kAxis and kAlike
    std::vector<Box3> boxes_;         ///< [node] of the subtree, of nodes with kBoxed photons
};

/// Number of nodes of the left subtree of a left-balanced tree of `count` nodes.
[[nodiscard]] std::size_t left_subtree_size(std::size_t count);

}  // namespace alhazen
