#include "alhazen/csg/csg_bvh.h"

#include <algorithm>

#include "alhazen/accel/wide_bvh/build/binary_builder.h"
#include "alhazen/primitives/bounded_primitives.h"

namespace alhazen {

namespace {

/// Lower bound of a direction's components relative to the largest one: quotients stay finite, and
/// the displacement of the ray is far below the pad.
constexpr double kLeastDirection = 0x1p-100;

/// The children of a wide node: descendants of the root, found by opening the largest first.
std::vector<std::uint32_t> opened(const BinaryBvh& binary, std::uint32_t root) {
    const auto area = [&](std::uint32_t n) {
        const FloatBox& b = binary.nodes[n].box;
        const double x = b.hi[0] - b.lo[0], y = b.hi[1] - b.lo[1], z = b.hi[2] - b.lo[2];
        return x * y + y * z + z * x;
    };
    std::vector<std::uint32_t> children{root};
    while (children.size() < CsgBvh::kWidth) {
        auto largest = children.end();
        for (auto i = children.begin(); i != children.end(); ++i) {
            if (binary.nodes[*i].is_leaf()) continue;
            if (largest == children.end() || area(*i) > area(*largest)) largest = i;
        }
        if (largest == children.end()) break;
        const std::uint32_t node = *largest;
        *largest = node + 1;
        children.push_back(binary.nodes[node].right);
    }
    return children;
}

}  // namespace

CsgBvh::CsgBvh(std::span<const Box3> boxes) {
    Box3 all;
    std::vector<std::uint32_t> bounded;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        const Box3& box = boxes[i];
        if (box.empty()) continue;
        const double reach = std::max(max_component(abs(box.lo)), max_component(abs(box.hi)));
        if (reach <= BoundedPrimitives::kReach) {
            bounded.push_back(i);
            all.include(box);
        } else {
            unbounded_.push_back(i);
        }
    }
    if (bounded.empty()) return;
    ranges_ = csg_ranges_kernel();
    frame_ = LocalFrame(all);
    std::vector<BuildReference> references;
    references.reserve(bounded.size());
    for (const std::uint32_t i : bounded) references.emplace_back(frame_.local(boxes[i]), i, 0);
    const BinaryBvh binary = build_binary(references, LeafKinds{});

    struct Open {
        std::uint32_t binary, wide;
    };
    nodes_.reserve(bounded.size() / 2 + 1);
    nodes_.emplace_back();
    std::vector<Open> open{{0, 0}};
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        const std::vector<std::uint32_t> children = opened(binary, next.binary);
        for (std::size_t c = 0; c < kWidth; ++c) {
            FloatBox box;
            std::uint32_t child = kLeafBit;
            if (c < children.size()) {
                const BinaryNode& node = binary.nodes[children[c]];
                box = node.box;
                if (node.is_leaf()) {
                    child = references[node.begin].id | kLeafBit;
                } else {
                    child = static_cast<std::uint32_t>(nodes_.size());
                    nodes_.emplace_back();
                    open.push_back({children[c], child});
                }
            }
            Node& wide = nodes_[next.wide];
            for (int k = 0; k < 3; ++k) {
                wide.lo[k][c] = box.lo[k];
                wide.hi[k][c] = box.hi[k];
            }
            wide.child[c] = child;
        }
    }
}

CsgBvh::RaySlabs CsgBvh::slabs(const Ray& ray, double pad) const {
    RaySlabs slabs;
    const Vec3 origin = frame_.local(ray.origin);
    const Vec3 direction = frame_.scale * ray.direction;
    const double local_pad = frame_.scale * pad;
    const double least = kLeastDirection * max_component(abs(direction));
    for (int k = 0; k < 3; ++k) {
        double d = direction[k];
        if (std::abs(d) < least) d = std::copysign(least, d);
        slabs.negative[k] = d < 0.0;
        slabs.inverse[k] = 1.0 / d;
        const double aside = std::copysign(local_pad, d);
        slabs.near_origin[k] = origin[k] + aside;
        slabs.far_origin[k] = origin[k] - aside;
    }
    return slabs;
}

}  // namespace alhazen
