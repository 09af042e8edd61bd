#include "alhazen/accel/bounds/bounding_volumes.h"

namespace alhazen {
namespace {

template <class B>
std::vector<B> bounds_of(const BoundsSource& source) {
    std::vector<B> bounds;
    bounds.reserve(source.size());
    for (std::size_t i = 0; i < source.size(); ++i) bounds.push_back(B::of(source, i));
    return bounds;
}

}  // namespace

BoundingVolumes BoundingVolumes::build(const BoundsSource& source, const Config& config) {
    BoundingVolumes made;
    switch (config.bound) {
        case BoundKind::Box:
        case BoundKind::Slabs3:
            made.bounds_ = bounds_of<BoxBound>(source);
            break;
        case BoundKind::Sphere:
            made.bounds_ = bounds_of<SphereBound>(source);
            break;
        case BoundKind::Ellipsoid:
            made.bounds_ = bounds_of<EllipsoidBound>(source);
            break;
        case BoundKind::Slabs7:
            made.bounds_ = bounds_of<SlabBound<7>>(source);
            break;
        case BoundKind::Slabs13:
            made.bounds_ = bounds_of<SlabBound<13>>(source);
            break;
    }
    return made;
}

std::size_t BoundingVolumes::memory_bytes() const {
    return std::visit([](const auto& bounds) { return bounds.capacity() * sizeof(bounds[0]); },
                      bounds_);
}

}  // namespace alhazen
