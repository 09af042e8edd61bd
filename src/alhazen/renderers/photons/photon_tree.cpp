#include "alhazen/renderers/photons/photon_tree.h"

#include <bit>
#include <numeric>

#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

/// Subtrees of at least this size are built in parallel.
constexpr std::size_t kLargeSubtree = 1u << 14;

int longest_axis(const Vec3& sides) {
    int longest = 0;
    for (int k = 1; k < 3; ++k) {
        if (sides[k] > sides[longest]) longest = k;
    }
    return longest;
}

/// Sets photons[i] to the old photons[from[i]]; `from` is a permutation, and the identity
/// afterwards.
void permute(std::vector<Photon>& photons, std::vector<std::uint32_t>& from) {
    for (std::uint32_t start = 0; start < from.size(); ++start) {
        const Photon first = photons[start];
        std::uint32_t at = start;
        while (from[at] != start) {
            const std::uint32_t next = from[at];
            photons[at] = photons[next];
            from[at] = at;
            at = next;
        }
        photons[at] = first;
        from[at] = at;
    }
}

}  // namespace

std::size_t left_subtree_size(std::size_t count) {
    if (count <= 1) return 0;
    const std::size_t half = std::bit_floor(count) / 2;  // size of the last level, on the left
    const std::size_t last = count - (std::bit_floor(count) - 1);
    return half - 1 + std::min(last, half);
}

void PhotonTree::keep_nearest(std::size_t count, std::vector<Near>& found) {
    if (found.size() <= count) return;
    thread_local std::vector<Near> sorted;
    sorted = found;
    const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(count - 1);
    std::nth_element(sorted.begin(), last, sorted.end());
    std::erase_if(found, [farthest = *last](const Near& near) { return farthest < near; });
}

PhotonTree::PhotonTree(std::vector<Photon> photons)
    : photons_(std::move(photons)), axes_(photons_.size()), boxes_(photons_.size() / kBoxed) {
    std::vector<std::uint32_t> order(photons_.size()), nodes(photons_.size());
    std::iota(order.begin(), order.end(), 0u);
    build(order, 0, nodes);
    permute(photons_, nodes);
    mark_alike();
}

void PhotonTree::mark_alike() {
    for (std::size_t node = photons_.size(); node-- > 0;) {
        bool alike = true;
        for (std::size_t child = 2 * node + 1; child < std::min(2 * node + 3, photons_.size());
             ++child) {
            alike = alike && (axes_[child] & kAlike) != 0 &&
                    photons_[child].normal == photons_[node].normal;
        }
        if (alike) axes_[node] |= kAlike;
    }
}

void PhotonTree::build(std::span<std::uint32_t> order, std::size_t node,
                       std::vector<std::uint32_t>& nodes) {
    if (order.empty()) return;
    Box3 box;
    for (const std::uint32_t i : order) box.include(photons_[i].point());
    if (node < boxes_.size()) boxes_[node] = box;
    const int axis = longest_axis(box.hi - box.lo);
    const std::size_t left = left_subtree_size(order.size());
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const auto k = static_cast<std::size_t>(axis);
        const double x = photons_[a].position[k], y = photons_[b].position[k];
        return x < y || (x == y && a < b);
    };
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(left), order.end(),
                     before);
    nodes[node] = order[left];
    axes_[node] = static_cast<std::uint8_t>(axis);
    const auto build_left = [&] { build(order.first(left), 2 * node + 1, nodes); };
    const auto build_right = [&] { build(order.subspan(left + 1), 2 * node + 2, nodes); };
    if (order.size() >= kLargeSubtree) {
        parallel_invoke(build_left, build_right);
    } else {
        build_left();
        build_right();
    }
}

}  // namespace alhazen
