#include "alhazen/shapes/patches/patch_lanes.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/patches/patch_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

static_assert(kBoxChildren == kLaneCount);

/// Puts the children that the line meets on the stack, the nearest on top.
HWY_INLINE void open_node(const PatchBoxes& node, PatchWalk& walk) {
    Floats near(walk.least), far(walk.most);
    for (int axis = 0; axis < 3; ++axis) {
        const Floats from(walk.from[axis]), inverse(walk.inverse[axis]);
        const bool down = walk.inverse[axis] < 0.0f;
        const Floats first = load_lanes(down ? node.hi[axis] : node.lo[axis]);
        const Floats second = load_lanes(down ? node.lo[axis] : node.hi[axis]);
        near = max_lanes(near, (first - from) * inverse);
        far = min_lanes(far, (second - from) * inverse);
    }
    std::uint32_t met = bits_of(near <= far);
    if (met == 0) return;
    HWY_ALIGN float nears[kLaneCount];
    store_lanes(near, nears);
    const int begin = walk.size;
    for (; met != 0; met &= met - 1) {
        const int k = __builtin_ctz(met);
        int place = walk.size++;
        for (; place > begin && walk.stack[place - 1].near < nears[k]; --place) {
            walk.stack[place] = walk.stack[place - 1];
        }
        walk.stack[place] = {nears[k], node.child[k]};
    }
}

bool next_leaf(const PatchBoxes* nodes, PatchWalk& walk, std::uint32_t& leaf) {
    while (walk.size > 0) {
        const PatchWalk::Waiting next = walk.stack[--walk.size];
        if (next.near > walk.most) continue;
        if ((next.child & kLeafChild) != 0) {
            leaf = next.child & ~kLeafChild;
            return true;
        }
        open_node(nodes[next.child], walk);
    }
    return false;
}

using Point = Lanes<double, 4>;

HWY_INLINE void cubic_values(double t, double (&values)[4], double (&derivatives)[4]) {
    const double s = 1.0 - t;
    const double ss = s * s, st = s * t, tt = t * t;
    values[0] = ss * s;
    values[1] = 3.0 * (ss * t);
    values[2] = 3.0 * (s * tt);
    values[3] = tt * t;
    derivatives[0] = -3.0 * ss;
    derivatives[1] = 3.0 * (ss - 2.0 * st);
    derivatives[2] = 3.0 * (2.0 * st - tt);
    derivatives[3] = 3.0 * tt;
}

HomogeneousValue bicubic(const BezierNet& net, double u, double v) {
    double bu[4], bv[4], cu[4], cv[4];
    cubic_values(u, bu, cu);
    cubic_values(v, bv, cv);
    Point s(0.0), s_u(0.0), s_v(0.0);
    for (std::size_t i = 0; i < 4; ++i) {
        Point row(0.0), row_v(0.0);
        for (std::size_t j = 0; j < 4; ++j) {
            const Point p = load_unaligned<4>(&net.points[4 * i + j].x);
            row = row + Point(bv[j]) * p;
            row_v = row_v + Point(cv[j]) * p;
        }
        s = s + Point(bu[i]) * row;
        s_u = s_u + Point(cu[i]) * row;
        s_v = s_v + Point(bu[i]) * row_v;
    }
    HWY_ALIGN double out[3][4];
    store_lanes(s, out[0]);
    store_lanes(s_u, out[1]);
    store_lanes(s_v, out[2]);
    const auto point = [](const double(&p)[4]) { return HomogeneousPoint{p[0], p[1], p[2], p[3]}; };
    return {point(out[0]), point(out[1]), point(out[2])};
}

}  // namespace

const PatchKernels& patch_kernels_of_target() {
    static constexpr PatchKernels kernels{&next_leaf, &bicubic};
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(patch_kernels_of_target);

const PatchKernels& patch_kernels() {
    // Called for every ray: the dispatch is cached.
    return HWY_DYNAMIC_DISPATCH(patch_kernels_of_target)();
}

}  // namespace alhazen
#endif
