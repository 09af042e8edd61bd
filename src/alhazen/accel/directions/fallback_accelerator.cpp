#include "alhazen/accel/directions/fallback_accelerator.h"

namespace alhazen {

FallbackAccelerator::Any FallbackAccelerator::make(const BoundsSource& source, Kind kind) {
    switch (kind) {
        case Kind::Hierarchy:
            return Hierarchy::build(source, {});
        case Kind::KdTree:
            return KdTree::build(source, {});
        case Kind::List:
            break;
    }
    return List::build(source, {});
}

void FallbackAccelerator::traverse_any(const Ray& ray, AnyVisitor& visitor, NoStats stats) const {
    std::visit([&](const auto& a) { a.traverse(ray, visitor, stats); }, accelerator_);
}

void FallbackAccelerator::traverse_any(const Ray& ray, AnyVisitor& visitor,
                                       CountingStats stats) const {
    std::visit([&](const auto& a) { a.traverse(ray, visitor, stats); }, accelerator_);
}

}  // namespace alhazen
