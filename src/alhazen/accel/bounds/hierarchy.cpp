#include "alhazen/accel/bounds/hierarchy.h"

namespace alhazen {

AnyBoundTree median_split_tree(const BoundsSource& source, NestingBound bound) {
    switch (bound) {
        case NestingBound::Sphere:
            return BoundTree<SphereBound>::median_split(source);
        case NestingBound::Slabs7:
            return BoundTree<SlabBound<7>>::median_split(source);
        case NestingBound::Slabs13:
            return BoundTree<SlabBound<13>>::median_split(source);
        case NestingBound::Box:
            break;
    }
    return BoundTree<BoxBound>::median_split(source);
}

std::size_t memory_bytes(const AnyBoundTree& tree) {
    return std::visit([](const auto& t) { return t.memory_bytes(); }, tree);
}

}  // namespace alhazen
