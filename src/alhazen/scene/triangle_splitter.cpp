#include "alhazen/scene/triangle_splitter.h"

#include <algorithm>
#include <cmath>

#include "alhazen/scene/leaf_blocks.h"
#include "alhazen/scene/primitive_table.h"

namespace alhazen {
namespace {

/// In float, outward by a step or two: cheaper than to the very next one, and what was tight before
/// is cut down to that again.
FloatBox rounded(const Box3& box) {
    FloatBox out;
    if (box.empty()) return out;
    for (int k = 0; k < 3; ++k) {
        const auto step = [](double x) { return std::abs(x) * 0x1p-23 + 0x1p-140; };
        out.lo[k] = static_cast<float>(box.lo[k] - step(box.lo[k]));
        out.hi[k] = static_cast<float>(box.hi[k] + step(box.hi[k]));
    }
    return out;
}

void intersect(FloatBox& box, const BuildReference& reference) {
    for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::max(box.lo[k], reference.lo[k]);
        box.hi[k] = std::min(box.hi[k], reference.hi[k]);
    }
}

}  // namespace

void split_triangle(const std::array<Vec3, 3>& corners, int axis, double plane, FloatBox& below,
                    FloatBox& above) {
    Box3 lower, upper;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 &a = corners[i], &b = corners[(i + 1) % 3];
        if (a[axis] <= plane) lower.include(a);
        if (a[axis] >= plane) upper.include(a);
        const bool crosses =
            (a[axis] < plane && plane < b[axis]) || (b[axis] < plane && plane < a[axis]);
        if (!crosses) continue;
        Vec3 cut = a + ((plane - a[axis]) / (b[axis] - a[axis])) * (b - a);
        cut[axis] = plane;
        lower.include(cut);
        upper.include(cut);
    }
    below = rounded(lower);
    above = rounded(upper);
}

bool TriangleSplitter::can_split(std::uint32_t kind) const {
    return kind == static_cast<std::uint32_t>(LeafType::Triangles);
}

void TriangleSplitter::split(const BuildReference& reference, int axis, float plane,
                             FloatBox& below, FloatBox& above) const {
    const std::uint32_t triangle = reference.id - table_.first(kTriangleKind);
    std::array<Vec3, 3> corners = table_.triangle_vertices(triangle);
    for (Vec3& p : corners) p = frame_.local(p);
    split_triangle(corners, axis, static_cast<double>(plane), below, above);
    intersect(below, reference);
    intersect(above, reference);
}

}  // namespace alhazen
