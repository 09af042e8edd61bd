#include "alhazen/accel/directions/ray_hypercubes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <span>

namespace alhazen {
namespace {

/// All rays that start in a box with directions in a cell.
class Beam {
  public:
    Beam(const Box3& voxel, int direction, const Hypercube& cube)
        : center_(voxel.center()), half_(voxel.hi - center_) {
        const int axis = direction / 2;
        for (std::size_t i = 0; i < 4; ++i) {
            Vec3& d = directions_[i];
            d[axis] = direction % 2 == 0 ? 1.0 : -1.0;
            d[(axis + 1) % 3] = (i & 1) != 0 ? cube.hi[3] : cube.lo[3];
            d[(axis + 2) % 3] = (i & 2) != 0 ? cube.hi[4] : cube.lo[4];
        }
    }

    /// True if all rays pass outside of one edge of a flat convex polygon. The side on which a ray
    /// passes a line is linear in its origin and in its direction, so that its extremes are at
    /// corners; a ray through the polygon passes all edges on the same side.
    [[nodiscard]] bool passes_beside(std::span<const Vec3> outline) const {
        const std::size_t n = outline.size();
        Vec3 area;
        for (std::size_t i = 2; i < n; ++i) {
            area += cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
        }
        const double least = 1e-6 * length(area);
        int front = 0, back = 0;
        for (const Vec3& d : directions_) {
            const double facing = dot(d, area);
            front += facing > least;
            back += facing < -least;
        }
        // Undecided if some rays see the polygon edge-on.
        if (front != 4 && back != 4) return false;
        const double sign = front == 4 ? 1.0 : -1.0;
        for (std::size_t i = 0; i < n; ++i) {
            if (passes_beside(outline[i] - center_, outline[(i + 1) % n] - center_, sign)) {
                return true;
            }
        }
        return false;
    }

  private:
    [[nodiscard]] bool passes_beside(const Vec3& a, const Vec3& b, double sign) const {
        const Vec3 moment = cross(a, b), edge = b - a;
        const double reach = std::max(max_component(abs(a)), max_component(abs(b)));
        double largest = -std::numeric_limits<double>::infinity();
        for (const Vec3& d : directions_) {
            largest = std::max(largest, sign * dot(d, moment) + dot(half_, abs(cross(edge, d))));
        }
        return largest < -1e-13 * reach * reach;
    }

    Vec3 center_, half_;
    std::array<Vec3, 4> directions_;
};

}  // namespace

/// The hypercubes that a thread used last, several per direction: as many as a row of pixels
/// traverses, so that the next row finds them.
struct RayHypercubes::Recent {
    static constexpr std::size_t kEach = 16;
    struct Entry {
        std::uint64_t id = 0;
        const List* list = nullptr;
        Hypercube cube;
    };
    std::array<std::array<Entry, kEach>, 6> entries;
    std::array<std::size_t, 6> last{};

    static Recent& of_thread(bool any_hit) {
        // Made at first use: as a thread-local value it would be cleared for every thread.
        static thread_local const auto recent = std::make_unique<std::array<Recent, 2>>();
        return (*recent)[any_hit ? 1 : 0];
    }
    /// Searches the most recent entries first.
    [[nodiscard]] const List* find(std::uint64_t id, const ClassifiedRay& ray) const {
        const auto d = static_cast<std::size_t>(ray.direction);
        for (std::size_t i = 0; i < kEach; ++i) {
            const Entry& e = entries[d][(last[d] + kEach - i) % kEach];
            if (e.id == id && e.cube.contains(ray.point)) return e.list;
        }
        return nullptr;
    }
    void add(std::uint64_t id, int direction, const Hypercube& cube, const List* list) {
        const auto d = static_cast<std::size_t>(direction);
        last[d] = (last[d] + 1) % kEach;
        entries[d][last[d]] = {id, list, cube};
    }
};

ClassifiedRay::ClassifiedRay(const Ray& ray, double t) {
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        if (std::abs(ray.direction[k]) > std::abs(ray.direction[axis])) axis = k;
    }
    direction = 2 * axis + (ray.direction[axis] > 0.0 ? 0 : 1);
    const Vec3 p = ray.at(t);
    const double speed = std::abs(ray.direction[axis]);
    point = {p.x, p.y, p.z, ray.direction[(axis + 1) % 3] / speed,
             ray.direction[(axis + 2) % 3] / speed};
}

std::uint32_t Hypercube::child_of(const std::array<double, 5>& p) const {
    std::uint32_t index = 0;
    for (std::size_t k = 0; k < 5; ++k) {
        index |= static_cast<std::uint32_t>(p[k] >= 0.5 * lo[k] + 0.5 * hi[k]) << k;
    }
    return index;
}

Hypercube Hypercube::child(std::uint32_t index) const {
    Hypercube made = *this;
    for (std::size_t k = 0; k < 5; ++k) {
        const double middle = 0.5 * lo[k] + 0.5 * hi[k];
        ((index >> k & 1u) != 0 ? made.lo : made.hi)[k] = middle;
    }
    return made;
}

RayHypercubes::RayHypercubes(const BoundsSource& source, const Limits& limits)
    : space_(source), bodies_(source), limits_(limits) {
    for (int d = 0; d < 6; ++d) {
        List& all = everything_[static_cast<std::size_t>(d)];
        all.resize(bodies_.size());
        std::iota(all.begin(), all.end(), 0u);
        std::stable_sort(all.begin(), all.end(), [&](std::uint32_t a, std::uint32_t b) {
            return begin_along(a, d) < begin_along(b, d);
        });
        least_bytes_ += all.capacity() * sizeof(all[0]);
    }
    trees_ = std::make_shared<Trees>(least_bytes_);
}

Hypercube RayHypercubes::root() const {
    const Box3& b = space_.box;
    return {{b.lo.x, b.lo.y, b.lo.z, -1, -1}, {b.hi.x, b.hi.y, b.hi.z, 1, 1}};
}

RayHypercubes::List RayHypercubes::meeting(const List& parent, int direction,
                                           const Hypercube& cube) const {
    const int axis = direction / 2;
    const double sign = direction % 2 == 0 ? 1.0 : -1.0;
    const Box3 voxel = space_.widened(
        {{cube.lo[0], cube.lo[1], cube.lo[2]}, {cube.hi[0], cube.hi[1], cube.hi[2]}});
    // All rays stay on one side of five planes: one behind the beam, and four beside it, with the
    // slopes of the outermost rays.
    struct HalfSpace {
        Vec3 normal;
        double steepness, least;
    };
    std::array<HalfSpace, 5> beam;
    const auto add = [&](std::size_t i, const Vec3& normal) {
        beam[i] = {normal, length(normal), extent(voxel, normal).lo};
    };
    Vec3 along;
    along[axis] = sign;
    add(0, along);
    for (int side = 0; side < 2; ++side) {
        const auto slope = static_cast<std::size_t>(3 + side);
        Vec3 across;
        across[(axis + 1 + side) % 3] = 1.0;
        add(static_cast<std::size_t>(1 + 2 * side), across - cube.lo[slope] * along);
        add(static_cast<std::size_t>(2 + 2 * side), cube.hi[slope] * along - across);
    }
    const Beam rays(voxel, direction, cube);
    List met;
    for (const std::uint32_t i : parent) {
        const bool inside = std::all_of(beam.begin(), beam.end(), [&](const HalfSpace& h) {
            return bodies_.extent(i, h.normal, h.steepness).hi >= h.least;
        });
        if (inside && !rays.passes_beside(bodies_.outline(i))) met.push_back(i);
    }
    met.shrink_to_fit();
    return met;
}

std::uint64_t RayHypercubes::new_id() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

RayHypercubes::Node* RayHypercubes::child_of(Trees& trees, Node& node, std::uint32_t index) const {
    const auto known = [&]() -> Node* {
        Node* child = node.first_child.load(std::memory_order_acquire);
        while (child != nullptr && child->index != index) child = child->next;
        return child;
    };
    if (Node* child = known()) return child;
    const std::lock_guard lock(trees.making);
    if (Node* child = known()) return child;
    if (trees.used + sizeof(Node) > limits_.memory_bytes) return nullptr;
    Node& child = trees.nodes.emplace_back();
    child.index = index;
    child.next = node.first_child.load(std::memory_order_relaxed);
    trees.used += sizeof(Node);
    ++trees.nodes_made;
    node.first_child.store(&child, std::memory_order_release);
    return &child;
}

const RayHypercubes::List* RayHypercubes::list_of(Trees& trees, Node& child, const List& parent,
                                                  int direction, const Hypercube& cube,
                                                  bool last) const {
    const List* known = child.list.load(std::memory_order_acquire);
    if (known != nullptr) return known;
    auto made = std::make_unique<const List>(meeting(parent, direction, cube));
    const std::lock_guard lock(trees.making);
    known = child.list.load(std::memory_order_relaxed);
    if (known != nullptr) return known;
    const std::size_t bytes = sizeof(List) + made->capacity() * sizeof(std::uint32_t);
    static const List nothing;
    // In an inner node, a list that is hardly shorter is not worth its memory.
    const bool divided = !last && made->size() > limits_.leaf_size;
    if (made->size() == parent.size() || (divided && made->size() > parent.size() / 4 * 3)) {
        known = &parent;  // inherited
    } else if (made->empty()) {
        known = &nothing;
    } else if (trees.used + bytes > limits_.memory_bytes) {
        return nullptr;
    } else {
        trees.used += bytes;
        known = trees.lists.emplace_back(std::move(made)).get();
    }
    child.list.store(known, std::memory_order_release);
    return known;
}

RayHypercubes::Leaf RayHypercubes::descend(Trees& trees, const ClassifiedRay& ray) const {
    const auto d = static_cast<std::size_t>(ray.direction);
    Node* node = &trees.roots[d];
    Leaf leaf{&everything_[d], root(), 0, true};
    while (leaf.list->size() > limits_.leaf_size && leaf.depth < limits_.max_depth) {
        const std::uint32_t index = leaf.cube.child_of(ray.point);
        node = child_of(trees, *node, index);
        const Hypercube part = leaf.cube.child(index);
        const List* shorter = node == nullptr ? nullptr
                                              : list_of(trees, *node, *leaf.list, ray.direction,
                                                        part, leaf.depth + 1 == limits_.max_depth);
        leaf.whole = shorter != nullptr;
        if (!leaf.whole) break;
        leaf = {shorter, part, leaf.depth + 1, true};
    }
    return leaf;
}

std::shared_ptr<RayHypercubes::Trees> RayHypercubes::begin_anew(
    const std::shared_ptr<Trees>& full) const {
    auto fresh = std::make_shared<Trees>(least_bytes_);
    std::shared_ptr<Trees> expected = full;
    return std::atomic_compare_exchange_strong(&trees_, &expected, fresh) ? fresh : expected;
}

RayHypercubes::Found RayHypercubes::find(ClassifiedRay ray, bool any_hit) const {
    // Rays from outside start on a face of the space, up to rounding.
    const Hypercube all = root();
    for (std::size_t k = 0; k < 5; ++k) {
        ray.point[k] = std::clamp(ray.point[k], all.lo[k], all.hi[k]);
    }
    std::shared_ptr<Trees> trees = std::atomic_load(&trees_);
    Recent& recent = Recent::of_thread(any_hit);
    if (const List* list = recent.find(trees->id, ray)) return {list, 1, true, std::move(trees)};
    Leaf leaf = descend(*trees, ray);
    if (!leaf.whole && trees->nodes_made > 6) {
        trees = begin_anew(trees);
        leaf = descend(*trees, ray);
    }
    recent.add(trees->id, ray.direction, leaf.cube, leaf.list);
    return {leaf.list, leaf.depth + 1, false, std::move(trees)};
}

}  // namespace alhazen
