// Bodies that another commit replaces.
#include "alhazen/shapes/patches/bilinear_patch.h"
#include "alhazen/shapes/patches/steiner_patch.h"

namespace alhazen {
struct SteinerImplicit {};
void BilinearPatch::validate(const FileLocation&, Diagnostics&) const {}
Box3 BilinearPatch::box() const {
    return {};
}
Interval BilinearPatch::extent(const Vec3&) const {
    return {};
}
int BilinearPatch::intersect(const Ray&, ShapeHit*) const {
    return 0;
}
ShapeSurface BilinearPatch::surface(const Ray&, const ShapeHit&) const {
    return {};
}
void SteinerPatch::prepare() {}
void SteinerPatch::validate(const FileLocation&, Diagnostics&) const {}
Interval SteinerPatch::extent(const Vec3&) const {
    return {};
}
int SteinerPatch::intersect(const Ray&, ShapeHit*) const {
    return 0;
}
ShapeSurface SteinerPatch::surface(const Ray&, const ShapeHit&) const {
    return {};
}
}  // namespace alhazen
