#include "alhazen/aggregates/wide_bvh/leaves/triangle_splitter.h"

#include <algorithm>
#include <cmath>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {
namespace {

/// Rounds to float, outward by a step or two: faster than to the nearest float; the caller clips
/// the parts to the box of their reference.
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

std::array<Vec3, 3> TriangleSplitter::corners(const BuildReference& reference) const {
    std::array<Vec3, 3> corners =
        table_.triangle_vertices(reference.id - table_.first(kTriangleKind));
    for (Vec3& p : corners) p = frame_.local(p);
    return corners;
}

void TriangleSplitter::split(const BuildReference& reference, int axis, float plane,
                             FloatBox& below, FloatBox& above) const {
    split_triangle(corners(reference), axis, static_cast<double>(plane), below, above);
    intersect(below, reference);
    intersect(above, reference);
}

void TriangleSplitter::slice(const BuildReference& reference, const BinPlanes& planes, int first,
                             int last, Box4* slices) const {
    const int axis = planes.axis;
    Float4 p[3];
    for (int i = 0; const Vec3& corner : corners(reference)) {
        p[i++] = Float4{static_cast<float>(corner.x), static_cast<float>(corner.y),
                        static_cast<float>(corner.z), 0};
    }
    std::fill_n(slices, last - first + 1, Box4());
    // A corner goes to its bin, a cut to both bins at its plane.
    const auto include = [&](int bin, Float4 point) {
        if (first <= bin && bin <= last) slices[bin - first].include_point(point);
    };
    for (int i = 0; i < 3; ++i) {
        const Float4 a = p[i], b = p[(i + 1) % 3];
        const int from = planes.bin(a[axis]), to = planes.bin(b[axis]);
        include(from, a);
        if (from == to) continue;
        const Float4 along = (b - a) * (1 / (b[axis] - a[axis]));
        const int end = std::min(std::max(from, to), last + 1);
        for (int k = std::max(std::min(from, to) + 1, first); k <= end; ++k) {
            const Float4 cut = a + along * (planes(k) - a[axis]);
            include(k - 1, cut);
            include(k, cut);
        }
    }
    const Box4 all(reference);
    for (int i = 0; i <= last - first; ++i) {
        Box4& slice = slices[i];
        slice.lo = slice.lo < all.lo ? all.lo : slice.lo;
        slice.hi = slice.hi > all.hi ? all.hi : slice.hi;
        if (slice.lo[0] > slice.hi[0] || slice.lo[1] > slice.hi[1] || slice.lo[2] > slice.hi[2]) {
            slice = Box4();
        }
    }
}

}  // namespace alhazen
