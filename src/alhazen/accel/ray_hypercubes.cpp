#include "alhazen/accel/ray_hypercubes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace alhazen {

/// The hypercubes that a thread used last, some for each direction.
struct RayHypercubes::Recent {
    static constexpr std::size_t kEach = 4;
    struct Entry {
        std::uint64_t id = 0;
        const List* list = nullptr;
        Hypercube cube;
    };
    std::array<std::array<Entry, kEach>, 6> entries;
    std::array<std::size_t, 6> next{};

    static Recent& of_thread() {
        static thread_local Recent recent;
        return recent;
    }
    [[nodiscard]] const List* find(std::uint64_t id, const ClassifiedRay& ray) const {
        for (const Entry& e : entries[static_cast<std::size_t>(ray.direction)]) {
            if (e.id == id && e.cube.contains(ray.point)) return e.list;
        }
        return nullptr;
    }
    void add(std::uint64_t id, int direction, const Hypercube& cube, const List* list) {
        const auto d = static_cast<std::size_t>(direction);
        entries[d][next[d]] = {id, list, cube};
        next[d] = (next[d] + 1) % kEach;
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
    static std::atomic<std::uint64_t> last_id{0};
    id_ = ++last_id;
    for (int d = 0; d < 6; ++d) {
        List& all = everything_[static_cast<std::size_t>(d)];
        all.resize(bodies_.size());
        std::iota(all.begin(), all.end(), 0u);
        std::stable_sort(all.begin(), all.end(), [&](std::uint32_t a, std::uint32_t b) {
            return begin_along(a, d) < begin_along(b, d);
        });
        roots_[static_cast<std::size_t>(d)].list = &all;
        used_ += all.capacity() * sizeof(all[0]);
    }
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
    // The rays stay on one side of five planes: behind all of them, and beside them, where the
    // slope of the plane is that of the outermost rays.
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
    List met;
    for (const std::uint32_t i : parent) {
        const bool inside = std::all_of(beam.begin(), beam.end(), [&](const HalfSpace& h) {
            return bodies_.extent(i, h.normal, h.steepness).hi >= h.least;
        });
        if (inside) met.push_back(i);
    }
    met.shrink_to_fit();
    return met;
}

RayHypercubes::Node* RayHypercubes::children_of(Node& node) const {
    Node* children = node.children.load(std::memory_order_acquire);
    if (children != nullptr) return children;
    const std::lock_guard lock(making_);
    children = node.children.load(std::memory_order_relaxed);
    constexpr std::size_t kBytes = kChildren * sizeof(Node);
    if (children != nullptr || used_ + kBytes > limits_.memory_bytes) return children;
    children = nodes_.emplace_back(std::make_unique<Node[]>(kChildren)).get();
    used_ += kBytes;
    nodes_made_ += kChildren;
    node.children.store(children, std::memory_order_release);
    return children;
}

const RayHypercubes::List* RayHypercubes::list_of(Node& child, const List& parent, int direction,
                                                  const Hypercube& cube) const {
    const List* known = child.list.load(std::memory_order_acquire);
    if (known != nullptr) return known;
    auto made = std::make_unique<const List>(meeting(parent, direction, cube));
    const std::lock_guard lock(making_);
    known = child.list.load(std::memory_order_relaxed);
    if (known != nullptr) return known;
    const std::size_t bytes = sizeof(List) + made->capacity() * sizeof(std::uint32_t);
    if (made->size() == parent.size()) {
        known = &parent;  // inherited
    } else if (used_ + bytes > limits_.memory_bytes) {
        return nullptr;
    } else {
        used_ += bytes;
        known = lists_.emplace_back(std::move(made)).get();
    }
    child.list.store(known, std::memory_order_release);
    return known;
}

RayHypercubes::Found RayHypercubes::find(ClassifiedRay ray) const {
    Hypercube cube = root();
    // Rays from outside begin in a face of the space, as near as rounding lets them.
    for (std::size_t k = 0; k < 5; ++k) {
        ray.point[k] = std::clamp(ray.point[k], cube.lo[k], cube.hi[k]);
    }
    Recent& recent = Recent::of_thread();
    if (const List* list = recent.find(id_, ray)) return {list, 1, true};
    const auto d = static_cast<std::size_t>(ray.direction);
    Node* node = &roots_[d];
    const List* list = &everything_[d];
    int depth = 0;
    while (list->size() > limits_.leaf_size && depth < limits_.max_depth) {
        Node* children = children_of(*node);
        if (children == nullptr) break;
        const std::uint32_t index = cube.child_of(ray.point);
        const Hypercube part = cube.child(index);
        const List* shorter = list_of(children[index], *list, ray.direction, part);
        if (shorter == nullptr) break;
        node = &children[index];
        list = shorter;
        cube = part;
        ++depth;
    }
    recent.add(id_, ray.direction, cube, list);
    return {list, depth + 1, false};
}

}  // namespace alhazen
