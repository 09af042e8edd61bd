#include <algorithm>
#include <cmath>

#include "alhazen/illumination/emitter.h"

namespace alhazen {

EmitterBounds bounds_of(const Emitter& e) {
    EmitterBounds bounds;
    const Mat3& own = e.world_from_own.linear;
    const Vec3 &x = own.x_axis, &y = own.y_axis, &z = own.z_axis;
    const Vec3& at = e.world_from_own.translation;
    bounds.axis = z;
    const auto include_round = [&](const Vec3& center, bool ball) {
        Vec3 reach;
        for (int k = 0; k < 3; ++k) {
            reach[k] = std::sqrt(x[k] * x[k] + y[k] * y[k] + (ball ? z[k] * z[k] : 0.0));
        }
        bounds.box.include(center - reach);
        bounds.box.include(center + reach);
    };
    switch (e.form) {
        case EmitterForm::Triangle:
            for (const Vec3& p : {at, at + x, at + y}) bounds.box.include(p);
            break;
        case EmitterForm::Rectangle:
            for (const Vec3& p : {at, at + x, at + y, at + x + y}) bounds.box.include(p);
            break;
        case EmitterForm::Disc:
            include_round(at, false);
            break;
        case EmitterForm::Polygon:
            for (const Vec3& p : e.parts->corners) bounds.box.include(p);
            break;
        case EmitterForm::Sphere:
            include_round(at, true);
            break;
        case EmitterForm::Tube:
            include_round(at, false);
            include_round(at + z, false);
            break;
        case EmitterForm::Patch:
            for (int i = 0; i < e.patch->net.count(); ++i) {
                const HomogeneousPoint& p = e.patch->net.points[static_cast<std::size_t>(i)];
                bounds.box.include(e.world_from_own.point(projected(p)));
            }
            break;
    }
    const bool curved = e.form == EmitterForm::Sphere || e.form == EmitterForm::Tube ||
                        e.form == EmitterForm::Patch;
    if (curved) {
        bounds.axis = {0, 0, 1};
        bounds.cosine_spread = -1.0;
    }
    bounds.center = bounds.box.center();
    if (e.form == EmitterForm::Triangle) bounds.center = at + (x + y) / 3.0;
    return bounds;
}

double rounding_within(const Affine& world_from_frame, const Box3& box) {
    const Affine inner = inverse(world_from_frame);
    const auto times = [](const Mat3& m, const Vec3& v) {
        return v.x * abs(m.x_axis) + v.y * abs(m.y_axis) + v.z * abs(m.z_axis);
    };
    const Vec3 most{std::max(std::abs(box.lo.x), std::abs(box.hi.x)),
                    std::max(std::abs(box.lo.y), std::abs(box.hi.y)),
                    std::max(std::abs(box.lo.z), std::abs(box.hi.z))};
    const Vec3 inside = times(inner.linear, most) + abs(inner.translation);
    const Vec3 terms = times(world_from_frame.linear, inside) + abs(world_from_frame.translation);
    return 0x1p-42 * max_component(terms);
}

}  // namespace alhazen
