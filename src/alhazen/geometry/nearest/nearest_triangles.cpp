#include "alhazen/geometry/nearest/nearest_triangles.h"

#include <algorithm>
#include <numeric>

#include "alhazen/base/interruption.h"

namespace alhazen {

namespace {

/// Of coordinates: a point on a triangle may be rounded out of its box by less.
constexpr double kBoxMargin = 8e-15;
/// Of squared distances, which are sums of three squares of rounded differences.
constexpr double kLess = 1.0 - 1e-14;

/// Not above the squared distance to whatever lies in the box, as it is computed.
double least_squared(const Box3& box, const Vec3& p) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double d = std::max({box.lo[k] - p[k], p[k] - box.hi[k], 0.0});
        sum += d * d;
    }
    return kLess * sum;
}

/// Twice the middle of the box of a triangle.
double doubled_middle(const NearestTriangles::Corners& c, int axis) {
    return std::min({c[0][axis], c[1][axis], c[2][axis]}) +
           std::max({c[0][axis], c[1][axis], c[2][axis]});
}

/// The widest axis of the middles, or -1 where they are one.
int axis_of(const std::vector<NearestTriangles::Corners>& triangles, const std::uint32_t* begin,
            const std::uint32_t* end) {
    Box3 middles;
    for (const std::uint32_t* id = begin; id != end; ++id) {
        const NearestTriangles::Corners& c = triangles[*id];
        middles.include(Vec3{doubled_middle(c, 0), doubled_middle(c, 1), doubled_middle(c, 2)});
    }
    const Vec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return size[axis] > 0.0 ? axis : -1;
}

}  // namespace

NearestTriangles::NearestTriangles(const std::vector<Corners>& triangles) {
    const auto count = static_cast<std::uint32_t>(triangles.size());
    if (count == 0) return;
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    nodes_.reserve(count);
    build(order, triangles, 0, count);
    corners_.reserve(count);
    for (const std::uint32_t id : order) corners_.push_back(triangles[id]);
    ids_ = std::move(order);
}

void NearestTriangles::build(std::vector<std::uint32_t>& order,
                             const std::vector<Corners>& triangles, std::uint32_t begin,
                             std::uint32_t end) {
    interruption_point();
    const std::size_t at = nodes_.size();
    Box3 box;
    for (std::uint32_t i = begin; i < end; ++i) {
        for (const Vec3& corner : triangles[order[i]]) box.include(corner);
    }
    nodes_.push_back({padded(box, kBoxMargin), begin, end - begin});
    if (end - begin <= kLeafSize) return;
    // Halves, whatever the middles are: the depth is that of a full tree.
    const std::uint32_t middle = begin + (end - begin) / 2;
    interruption_point();
    const int axis = axis_of(triangles, order.data() + begin, order.data() + end);
    interruption_point();
    if (axis >= 0) {
        std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             const double x = doubled_middle(triangles[a], axis);
                             const double y = doubled_middle(triangles[b], axis);
                             return x < y || (x == y && a < b);
                         });
    }
    build(order, triangles, begin, middle);
    nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[at].count = 0;
    build(order, triangles, middle, end);
}

NearestTriangle NearestTriangles::nearest(const Vec3& point) const {
    NearestTriangle best;
    if (nodes_.empty() || !is_finite(point)) return best;
    struct Waiting {
        std::uint32_t node;
        double least;
    };
    std::array<Waiting, 40> stack;  // one for each level: at most 32
    std::size_t size = 0;
    stack[size++] = {0, least_squared(nodes_[0].box, point)};
    while (size > 0) {
        const Waiting top = stack[--size];
        if (top.least > best.squared) continue;
        const Node& node = nodes_[top.node];
        if (node.count > 0) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                const PointOnTriangle found = nearest_on_triangle(point, corners_[i]);
                const bool nearer = found.squared < best.squared ||
                                    (found.squared == best.squared && ids_[i] < best.triangle);
                if (!nearer) continue;
                static_cast<PointOnTriangle&>(best) = found;
                best.triangle = ids_[i];
            }
            continue;
        }
        Waiting near{top.node + 1, least_squared(nodes_[top.node + 1].box, point)};
        Waiting far{node.first, least_squared(nodes_[node.first].box, point)};
        if (far.least < near.least) std::swap(near, far);
        stack[size++] = far;
        stack[size++] = near;
    }
    return best;
}

}  // namespace alhazen
