#include "alhazen/verification/exact_bounds.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "alhazen/csg/solid_aggregate.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

namespace {

/// The image of a box, not widened for rounding.
Box3 placed(const Affine& outer_from_inner, const Box3& box) {
    Box3 image;
    for (int i = 0; i < 8; ++i) image.include(outer_from_inner.point(box.corner(i)));
    return image;
}

/// Removes the margin of a few roundings by rounding to 13 digits of the largest coordinate.
Box3 without_margin(Box3 box) {
    const double reach = std::max(max_component(abs(box.lo)), max_component(abs(box.hi)));
    const double digits = 13.0 - std::ceil(std::log10(reach));
    constexpr double kExactPowers = 22.0;  // powers of ten that double represents exactly
    if (!(digits >= 0.0 && digits <= kExactPowers)) return box;
    const double scale = std::pow(10.0, digits);
    for (int i = 0; i < 3; ++i) {
        box.lo[i] = std::round(box.lo[i] * scale) / scale + 0.0;  // no -0
        box.hi[i] = std::round(box.hi[i] * scale) / scale + 0.0;
    }
    return box;
}

class ExactBounds {
  public:
    /// Validation bounds the nesting: recursion is safe here.
    const Box3& of(const Aggregate& aggregate) {
        const auto known = boxes_.find(&aggregate);
        if (known != boxes_.end()) return known->second;
        Box3 sum;
        // The result of a CSG operation has no exact box of its own.
        if (dynamic_cast<const SolidAggregate*>(&aggregate) != nullptr) {
            const Box3 box = aggregate.box();
            if (!box.empty() && box.bounded()) sum = without_margin(box);
            return boxes_[&aggregate] = sum;
        }
        const PrimitiveTable& table = aggregate.primitives();
        std::apply([&](const auto&... column) { (add_shapes(column, table, sum), ...); },
                   table.columns);
        for (const PlacedMesh& mesh : table.meshes) add(mesh.mesh->box(), sum);
        for (const Instance& instance : table.instances) add_instance(instance, sum);
        return boxes_[&aggregate] = sum;
    }

  private:
    static void add(const Box3& box, Box3& sum) {
        if (!box.empty() && box.bounded()) sum.include(box);
    }

    template <class Column>
    static void add_shapes(const Column& column, const PrimitiveTable& table, Box3& sum) {
        for (std::size_t i = 0; i < column.shapes.size(); ++i) {
            const Box3 inner = column.shapes[i].box();
            if (inner.empty() || !inner.bounded()) continue;
            const Box3 box = without_margin(inner);
            const std::uint32_t placement = column.placements[i];
            add(placement == kNoPlacement
                    ? box
                    : placed(table.placements[placement].outer_from_inner, box),
                sum);
        }
    }

    void add_instance(const Instance& instance, Box3& sum) {
        const PrimitiveTable& inner = instance.aggregate->primitives();
        const Affine& outer_from_inner = instance.placement.outer_from_inner;
        std::size_t corners = 0;
        for (const PlacedMesh& mesh : inner.meshes) corners += 3 * mesh.mesh->triangles.size();
        const bool only_meshes = inner.first(kTriangleKind) == 0 && inner.instances.empty();
        if (!only_meshes || corners > corners_left_) {
            const Box3& box = of(*instance.aggregate);
            if (!box.empty()) add(placed(outer_from_inner, box), sum);
            return;
        }
        corners_left_ -= corners;
        for (const PlacedMesh& mesh : inner.meshes) {
            for (const auto& triangle : mesh.mesh->triangles) {
                for (const std::uint32_t vertex : triangle) {
                    sum.include(outer_from_inner.point(mesh.mesh->positions[vertex]));
                }
            }
        }
    }

    std::map<const Aggregate*, Box3> boxes_;
    std::size_t corners_left_ = kMaxPlacedCorners;
};

}  // namespace

Box3 exact_bounds(const Aggregate& aggregate) {
    return ExactBounds().of(aggregate);
}

}  // namespace alhazen
