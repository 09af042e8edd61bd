#include "alhazen/shapes/quadrics/quadric.h"

namespace alhazen {

void Quadric::prepare() {
    QuadricForm form{squares.x,        squares.y,        squares.z,      0.5 * products.x,
                     0.5 * products.y, 0.5 * products.z, 0.5 * linear.x, 0.5 * linear.y,
                     0.5 * linear.z,   constant};
    // Lines are shifted to near the origin: within the clip, or the region where f may be 0.
    double size = 0.0;
    for (int k = 0; k < 3; ++k) {
        size = std::fmax(size, std::fmax(std::abs(clip_box.lo[k]), std::abs(clip_box.hi[k])));
    }
    if (!std::isfinite(size)) {
        const double second = max_component(abs(squares)) + max_component(abs(products));
        size = second > 0.0
                   ? max_component(abs(linear)) / second + std::sqrt(std::abs(constant) / second)
                   : 1.0;
    }
    if (!(size > 0.0)) size = 1.0;
    solid.quadric = QuadricLine(form, size);
    solid.clip_box = clip_box;
    solid.planes = clip_planes;
    solid.capped = capped;
    solid.v_kind = ClippedQuadric::V::Latitude;
    solid.least_slope = 0.2;
}

void Quadric::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    if (!(std::abs(constant) <= kMaxCoordinate))
        checks.fail("constant must be a number below 1e70");
    if (squares == Vec3{} && products == Vec3{} && linear == Vec3{}) {
        checks.fail("not all of squares, products and linear may be zero");
    }
    for (int k = 0; k < 3; ++k) {
        if (!(clip_box.lo[k] < clip_box.hi[k])) {
            checks.fail("clip_box must be ((x, y, z), (x, y, z)) with the lower corner first");
            break;
        }
    }
    for (const ClipPlane& plane : clip_planes) {
        checks.vector("normal of clip_planes", plane.normal);
        if (!(std::abs(plane.offset) <= kMaxCoordinate)) {
            checks.fail("offset of clip_planes must be a number below 1e70");
        }
    }
    if (clip_planes.size() > 1000) checks.fail("clip_planes must be at most 1000");
}

Interval Quadric::extent(const Vec3& axis) const {
    const Interval range = alhazen::extent(clip_box, axis);
    const double pad = gamma_bound(8) * (std::abs(range.lo) + std::abs(range.hi));
    return std::isfinite(pad) ? Interval{range.lo - pad, range.hi + pad} : range;
}

}  // namespace alhazen
