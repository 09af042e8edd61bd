#include "alhazen/geometry/bounds_source.h"

namespace alhazen {

Interval extent(const Box3& box, const Vec3& axis) {
    Interval range{0.0, 0.0};
    for (int k = 0; k < 3; ++k) {
        if (axis[k] == 0.0) continue;  // keeps 0 * inf out of unbounded boxes
        const double a = axis[k] * box.lo[k];
        const double b = axis[k] * box.hi[k];
        range.lo += std::min(a, b);
        range.hi += std::max(a, b);
    }
    return range;
}

Interval BoundsSource::extent(std::size_t i, const Vec3& axis) const {
    return alhazen::extent(box(i), axis);
}

BoundingSphere bounding_sphere(const Box3& box) {
    // The margin covers the rounding of the center and of the distance.
    return {box.center(),
            (1.0 + 1e-15) * (0.5 * length(box.size())) + 1e-15 * max_component(abs(box.center()))};
}

BoundingSphere BoundsSource::sphere(std::size_t i) const {
    return bounding_sphere(box(i));
}

bool BoundsSource::overlaps(std::size_t i, const Box3& cell) const {
    const Box3 b = box(i);
    return b.lo.x <= cell.hi.x && cell.lo.x <= b.hi.x && b.lo.y <= cell.hi.y &&
           cell.lo.y <= b.hi.y && b.lo.z <= cell.hi.z && cell.lo.z <= b.hi.z;
}

Box3 BoundsSource::clipped_box(std::size_t i, const Box3& cell) const {
    const Box3 b = box(i);
    return {
        {std::max(b.lo.x, cell.lo.x), std::max(b.lo.y, cell.lo.y), std::max(b.lo.z, cell.lo.z)},
        {std::min(b.hi.x, cell.hi.x), std::min(b.hi.y, cell.hi.y), std::min(b.hi.z, cell.hi.z)}};
}

std::optional<std::array<Vec3, 3>> BoundsSource::triangle(std::size_t) const {
    return std::nullopt;
}

bool BoundsSource::blocks_light(std::size_t) const {
    return false;
}

std::span<const RayEnd> BoundsSource::ray_ends() const {
    return {};
}

}  // namespace alhazen
