#pragma once
/// Divides triangles for the builder with spatial splits.
///
/// Conventions: in the frame of the tree, in double, rounded outward. The rounding errors of the
/// transform into that frame and of the cut are far below the displacement that the slab test
/// covers (LocalRay::delta), so no point of a triangle is lost between two boxes.

#include <array>

#include "alhazen/accel/wide_bvh/build/spatial_split.h"
#include "alhazen/accel/wide_bvh/nodes/local_frame.h"

namespace alhazen {

class PrimitiveTable;

class TriangleSplitter final : public ReferenceSplitter {
  public:
    /// Keeps references.
    TriangleSplitter(const PrimitiveTable& table, const LocalFrame& frame)
        : table_(table), frame_(frame) {}

    [[nodiscard]] bool can_split(std::uint32_t kind) const override;
    void split(const BuildReference& reference, int axis, float plane, FloatBox& below,
               FloatBox& above) const override;
    void slice(const BuildReference& reference, const BinPlanes& planes, int first, int last,
               Box4* slices) const override;

  private:
    /// The corners in the frame of the tree.
    [[nodiscard]] std::array<Vec3, 3> corners(const BuildReference& reference) const;

    const PrimitiveTable& table_;
    const LocalFrame& frame_;
};

/// The boxes of the parts of a triangle on both sides of a plane; empty if there is none.
void split_triangle(const std::array<Vec3, 3>& corners, int axis, double plane, FloatBox& below,
                    FloatBox& above);

}  // namespace alhazen
