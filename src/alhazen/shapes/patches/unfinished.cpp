// Bodies that another commit replaces.
#include "alhazen/shapes/patches/steiner_patch.h"

namespace alhazen {
struct SteinerImplicit {};
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
