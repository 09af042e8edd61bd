#include "alhazen/geometry/nearest/nearest_triangles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "alhazen/base/interruption.h"

namespace alhazen {

namespace {

/// Margin of box coordinates: the rounding of a point on a triangle is smaller.
constexpr double kBoxMargin = 8e-15;
/// Margin of squared distances, which are sums of three squares of rounded differences.
constexpr double kLess = 1.0 - 1e-14;

/// A lower bound of the squared distance, as computed, to the contents of the box.
double least_squared(const Box3& box, const Vec3& p) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double d = std::max({box.lo[k] - p[k], p[k] - box.hi[k], 0.0});
        sum += d * d;
    }
    return kLess * sum;
}

/// The nearest float that is not below `x`.
float rounded_up(double x) {
    const auto f = static_cast<float>(x);
    return double{f} >= x ? f : std::nextafter(f, std::numeric_limits<float>::infinity());
}

/// Twice the centre of the box of a triangle.
double doubled_middle(const NearestTriangles::Corners& c, int axis) {
    return std::min({c[0][axis], c[1][axis], c[2][axis]}) +
           std::max({c[0][axis], c[1][axis], c[2][axis]});
}

/// The axis of the largest extent of the triangles' centres, or -1 if the centres coincide.
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

void NearestTriangles::set_cylinder(Node& node, const std::vector<Corners>& triangles,
                                    std::span<const std::uint32_t> ids) {
    Vec3 sum;
    for (const std::uint32_t id : ids) {
        const auto& [a, b, c] = triangles[id];
        const Vec3 normal = cross(b - a, c - a);
        // Normals of neighbouring triangles may point the opposite way.
        sum += dot(normal, sum) < 0.0 ? -normal : normal;
    }
    const double length = std::sqrt(length_squared(sum));
    if (!(length > 0.0) || !std::isfinite(length)) return;
    const Vec3 axis = (1.0 / length) * sum, middle = node.box.center();
    if (!(std::abs(length_squared(axis) - 1.0) < 2e-15)) return;
    double half = 0.0, squared = 0.0;
    for (const std::uint32_t id : ids) {
        for (const Vec3& corner : triangles[id]) {
            const Vec3 offset = corner - middle;
            const double along = dot(axis, offset);
            half = std::max(half, std::abs(along));
            squared = std::max(squared, length_squared(offset - along * axis));
        }
    }
    // A cylinder that is not flat is no better than the box.
    constexpr double kFlat = 0.25;
    if (half * half > kFlat * kFlat * squared) return;
    const double largest =
        std::max(max_component(abs(node.box.lo)), max_component(abs(node.box.hi)));
    const double margin = 4.0 * kBoxMargin * largest;
    node.axis = axis;
    node.half_height = rounded_up(half + margin);
    node.radius = rounded_up(std::sqrt(squared) + margin);
}

/// A lower bound of the squared distance, as computed, to the triangles in the cylinder.
double NearestTriangles::least_to_cylinder(const Node& node, const Vec3& point) {
    // Relative to a squared length; covers the rounding of the values subtracted from it.
    constexpr double kSlack = 8e-15;
    const Vec3 offset = point - node.box.center();
    const double squared = length_squared(offset), along = std::abs(dot(node.axis, offset));
    const double across = std::sqrt(std::max(0.0, squared - along * along - kSlack * squared));
    const double above = along - kSlack * std::sqrt(squared) - double{node.half_height};
    const double beside = (1.0 - kSlack) * across - double{node.radius};
    double sum = 0.0;
    if (above > 0.0) sum += above * above;
    if (beside > 0.0) sum += beside * beside;
    return kLess * sum;
}

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
    Node& node = nodes_.emplace_back();
    node.box = padded(box, kBoxMargin);
    node.first = begin;
    node.count = end - begin;
    constexpr std::uint32_t kMostInCylinder = 1024;
    if (end - begin <= kMostInCylinder) {
        set_cylinder(node, triangles, std::span(order).subspan(begin, end - begin));
    }
    if (end - begin <= kLeafSize) return;
    // Halves regardless of the centres: the depth is that of a full tree.
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
    std::array<Waiting, 40> stack;  // one entry for each level: at most 32
    std::size_t size = 0;
    stack[size++] = {0, least_squared(nodes_[0].box, point)};
    while (size > 0) {
        const Waiting top = stack[--size];
        if (top.least > best.squared) continue;
        const Node& node = nodes_[top.node];
        if (node.radius < std::numeric_limits<float>::infinity() &&
            least_to_cylinder(node, point) > best.squared) {
            continue;
        }
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
