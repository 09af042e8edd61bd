#include "alhazen/shapes/patches/patch_index.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

PatchIndex::PatchIndex(const PatchPieces& pieces, const Box3& box) {
    frame_.center = box.empty() ? Vec3{} : box.center();
    const double half = 0.5 * max_component(box.size());
    frame_.scale = half > 0.0 ? 1.0 / half : 1.0;
    far_ = 2.0 * length(box.size());
    std::vector<PatchLeaf> leaves;
    std::vector<Box3> boxes;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const BezierNet net = pieces[k].net;
        append_leaves(net, static_cast<std::uint32_t>(k), frame_, leaves, boxes);
        for (int i = 0; i < net.count(); ++i) {
            const HomogeneousPoint& p = net.points[static_cast<std::size_t>(i)];
            reach_ = std::max(reach_, length(Vec3{p.x, p.y, p.z}));
            most_weight_ = std::max(most_weight_, p.w);
        }
    }
    std::vector<std::uint32_t> order;
    nodes_ = make_patch_boxes(boxes, order);
    nodes_.shrink_to_fit();
    leaves_.reserve(leaves.size());
    for (const std::uint32_t k : order) leaves_.push_back(leaves[k]);
}

PatchLine PatchIndex::line_of(const Ray& ray) const {
    PatchLine line;
    Vec3 direction = ray.direction;
    double unit = 1.0;
    if (const double square = length_squared(direction); !(square > 1e-200 && square < 1e200)) {
        unit = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
        direction = direction / unit;
    }
    const double size = length(direction);
    line.direction = direction / size;
    line.per_length = 1.0 / size / unit;
    line.origin = ray.origin;
    const Vec3 to_center = frame_.center - ray.origin;
    if (length(to_center) > far_) {
        // Starts from the point nearest to the centre, for smaller rounding errors.
        const double distance = dot(to_center, line.direction);
        line.origin = ray.origin + distance * line.direction;
        line.shift = distance * line.per_length;
    }
    line.tiny = 0x1p-46 * (reach_ + most_weight_ * length(line.origin));
    return line;
}

bool PatchIndex::is_near(const PatchLine& line) const {
    // A line through the box has an origin at most a few times as far away as the patches.
    return line.tiny <= 0x1p-20 * reach_ && std::isfinite(line.per_length) &&
           length_squared(line.direction) > 0.5;
}

void PatchIndex::add_axes(PatchLine& line) {
    line.axis_x = perpendicular(line.direction);
    line.axis_y = cross(line.direction, line.axis_x);
}

float PatchIndex::place(const PatchLine& line, double t, double side) const {
    const double x = (t - line.shift) * (frame_.scale / line.per_length);
    return static_cast<float>(std::clamp(x + side * (1e-5 + 1e-6 * std::abs(x)), -1e30, 1e30));
}

PatchTraversal PatchIndex::walk_of(const PatchLine& line, double t_min, double limit) const {
    PatchTraversal walk;
    const Vec3 origin = in_frame(line.origin);
    for (int axis = 0; axis < 3; ++axis) {
        const double d = line.direction[axis];
        walk.from[axis] = static_cast<float>(origin[axis]);
        walk.inverse[axis] =
            static_cast<float>(1.0 / std::copysign(std::max(std::abs(d), 1e-18), d));
    }
    walk.least = place(line, t_min, -1.0);
    walk.most = place(line, limit, 1.0);
    walk.set_planes();
    walk.size = 1;
    walk.stack[0] = PatchTraversal::Waiting::of(walk.least, 0);
    return walk;
}

bool PatchIndex::side_by_side(std::span<const Ray* const> rays) {
    constexpr std::size_t kFewest = 4;
    constexpr double kNarrow = 0.99;
    if (rays.size() < kFewest) return false;
    const Vec3& first = rays[0]->direction;
    const double least = kNarrow * kNarrow * dot(first, first);
    return std::all_of(rays.begin() + 1, rays.end(), [&](const Ray* ray) {
        const double along = dot(ray->direction, first);
        return along > 0.0 && along * along > least * dot(ray->direction, ray->direction);
    });
}

std::size_t PatchIndex::bytes() const {
    return sizeof *this + leaves_.capacity() * sizeof(PatchLeaf) +
           nodes_.capacity() * sizeof(PatchBoxes);
}

}  // namespace alhazen
