#include "alhazen/shapes/blobs/blob_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace alhazen {

BlobTree::BlobTree(const std::vector<Box3>& boxes) : order_(boxes.size()), boxes_(boxes) {
    std::iota(order_.begin(), order_.end(), 0u);
    build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
    for (const Box3& box : boxes) {
        const Vec3 size = box.size();
        mean_radius_ += 0.5 * std::min({size.x, size.y, size.z}) / double(boxes.size());
    }
}

void BlobTree::add_sphere(const Vec3& center, double radius) {
    if (spheres_.empty() || spheres_.back().used == BlobSpheres::kAll) spheres_.emplace_back();
    BlobSpheres& last = spheres_.back();
    const auto i = static_cast<std::size_t>(std::popcount(last.used));
    last.x[i] = center.x;
    last.y[i] = center.y;
    last.z[i] = center.z;
    last.radius[i] = (1.0 + 0x1p-40) * radius + 0x1p-40 * max_component(abs(center));
    last.used |= 1u << i;
}

// Halving limits the depth to 33.
void BlobTree::build(const std::vector<Box3>& boxes, std::uint32_t first, std::uint32_t end) {
    const std::size_t at = nodes_.size();
    nodes_.emplace_back();
    Box3 box;
    for (std::uint32_t i = first; i < end; ++i) box.include(boxes[order_[i]]);
    nodes_[at].box = box;
    if (end - first <= kLeafSize) {
        nodes_[at].first = first;
        nodes_[at].count = end - first;
        return;
    }
    const Vec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::uint32_t middle = first + (end - first) / 2;
    const auto begin = order_.begin();
    std::nth_element(begin + first, begin + middle, begin + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double ca = boxes[a].lo[axis] + boxes[a].hi[axis];
                         const double cb = boxes[b].lo[axis] + boxes[b].hi[axis];
                         return ca != cb ? ca < cb : a < b;
                     });
    build(boxes, first, middle);
    nodes_[at].second_child = static_cast<std::uint32_t>(nodes_.size());
    build(boxes, middle, end);
}

// Separating axis test of line and box, without a division. All lengths are doubled.
bool BlobTree::meets_line(const Box3& box, const Vec3& o, const Vec3& d, double pad) {
    const Vec3 m = (box.lo + box.hi) - 2.0 * o;
    const Vec3 size = (box.hi - box.lo) + Vec3{2.0 * pad, 2.0 * pad, 2.0 * pad};
    const Vec3 a = abs(d);
    return !(std::abs(m.y * d.z - m.z * d.y) > size.y * a.z + size.z * a.y ||
             std::abs(m.z * d.x - m.x * d.z) > size.z * a.x + size.x * a.z ||
             std::abs(m.x * d.y - m.y * d.x) > size.x * a.y + size.y * a.x);
}

}  // namespace alhazen
