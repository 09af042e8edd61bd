#include "alhazen/shapes/patches/patch_lanes.h"

#include <limits>

#include "alhazen/simd/dispatch.h"

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

static_assert(kBoxChildren == 2 * kLaneCount);

/// Children in the order in which they are pushed onto the stack.
class SortedChildren {
  public:
    SortedChildren(const PatchBoxes& node, const float* nears) : node_(node), nears_(nears) {}

    /// Sorts two to four by a branchless network, as branches would be mispredicted.
    HWY_INLINE void put_few(std::uint32_t met, PatchTraversal::Waiting* to) const {
        std::int64_t keys[4];
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i, met &= met - 1) {
            const std::int64_t key = key_of(static_cast<std::uint32_t>(
                __builtin_ctz(met | std::uint32_t{1} << (kBoxChildren - 1))));
            // Missing children sort before all others.
            keys[i] = met != 0 ? key : std::numeric_limits<std::int64_t>::min();
        }
        order(keys[0], keys[1]);
        order(keys[2], keys[3]);
        order(keys[0], keys[2]);
        order(keys[1], keys[3]);
        order(keys[1], keys[2]);
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) to[i] = waiting_of(keys[i]);
    }
    HWY_INLINE PatchTraversal::Waiting one(std::uint32_t k) const {
        return PatchTraversal::Waiting::of(nears_[k], node_.child[k]);
    }
    /// Sorts any number.
    HWY_INLINE void put(std::uint32_t met, PatchTraversal::Waiting* const begin) const {
        for (PatchTraversal::Waiting* end = begin; met != 0; met &= met - 1) {
            const auto k = static_cast<std::uint32_t>(__builtin_ctz(met));
            PatchTraversal::Waiting* place = end++;
            for (; place > begin && place[-1].near() < nears_[k]; --place) place[0] = place[-1];
            *place = one(k);
        }
    }

  private:
    /// Maps the bits of floats to integers in the same order.
    static HWY_INLINE std::int32_t ordered(std::int32_t bits) {
        return bits ^ ((bits >> 31) & 0x7fffffff);
    }
    HWY_INLINE std::int64_t key_of(std::uint32_t k) const {
        const std::int64_t near = ordered(std::bit_cast<std::int32_t>(nears_[k]));
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(near) << 32 | node_.child[k]);
    }
    static HWY_INLINE PatchTraversal::Waiting waiting_of(std::int64_t key) {
        const auto near = static_cast<std::uint32_t>(ordered(static_cast<std::int32_t>(key >> 32)));
        return {std::uint64_t{near} << 32 | static_cast<std::uint32_t>(key)};
    }
    static HWY_INLINE void order(std::int64_t& first, std::int64_t& second) {
        const std::int64_t a = first, b = second;
        first = a > b ? a : b;
        second = a > b ? b : a;
    }

    const PatchBoxes& node_;
    const float* nears_;
};

/// Pushes children onto the stack, the nearest on top.
HWY_INLINE void push_children(const PatchBoxes& node, const float* nears, std::uint32_t met,
                              PatchTraversal& walk) {
    PatchTraversal::Waiting* const top = walk.stack + walk.size;
    const SortedChildren children(node, nears);
    const int count = std::popcount(met);
    walk.size += count;
    // Most often none or one, which a branch would mispredict.
    *top = children.one(met != 0 ? static_cast<std::uint32_t>(__builtin_ctz(met)) : 0);
    if (count < 2) return;
    if (count <= 4) return children.put_few(met, top);
    children.put(met, top);
}

/// Converts eight bytes.
HWY_INLINE Floats floats_of(const std::uint8_t* bytes) {
    const LaneTag<float> d;
    const hn::RebindToSigned<LaneTag<float>> di;
    const hn::Rebind<std::uint8_t, LaneTag<float>> du;
    Floats r;
    for (std::size_t i = 0; i < kParts<float>; ++i) {
        const auto part = hn::LoadU(du, bytes + i * hn::Lanes(d));
        r.part[i] = hn::ConvertTo(d, hn::PromoteTo(di, part));
    }
    return r;
}

/// The set of children that the line meets; writes their distances to nears[child].
HWY_INLINE std::uint32_t test_node(const PatchBoxes& node, const PatchTraversal& walk,
                                   float* nears) {
    static_assert(offsetof(PatchBoxes, step) == offsetof(PatchBoxes, from) + 12 &&
                  offsetof(PatchTraversal, inverse) == offsetof(PatchTraversal, from) + 12 &&
                  offsetof(PatchTraversal, least) == offsetof(PatchTraversal, inverse) + 12);
    // Computes three axes at once; a fourth number is ignored, the last of `begins` and the first
    // of `steps`.
    HWY_ALIGN float begins[4], steps[4];
    const Lanes<float, 4> inverse = load_unaligned<4>(walk.inverse);
    store_lanes((load_unaligned<4>(node.from) - load_unaligned<4>(walk.from)) * inverse, begins);
    store_lanes(load_unaligned<4>(node.from + 2) * load_unaligned<4>(walk.from + 2), steps);
    const std::uint8_t* const planes = &node.planes[0][0][0];
    std::uint32_t met = 0;
    ALHAZEN_UNROLL
    for (std::size_t half = 0; half < kBoxChildren; half += kLaneCount) {
        Floats near(walk.least), far(walk.most);
        ALHAZEN_UNROLL
        for (int axis = 0; axis < 3; ++axis) {
            const Floats begin(begins[axis]), step(steps[1 + axis]);
            const Floats first = floats_of(planes + walk.enters[axis] + half);
            const Floats second = floats_of(planes + walk.leaves[axis] + half);
            // kBoxMargin allows for the rounding of fused and separate operations.
            near = max_lanes(near, mul_add(first, step, begin));
            far = min_lanes(far, mul_add(second, step, begin));
        }
        met |= bits_of(near <= far) << half;
        store_lanes(near, nears + half);
    }
    return met & node.used;
}

/// Pushes the children that the line meets onto the stack.
HWY_INLINE void open_node(const PatchBoxes& node, PatchTraversal& walk) {
    HWY_ALIGN float nears[kBoxChildren];
    push_children(node, nears, test_node(node, walk, nears), walk);
}

/// Pushes the children that a line of a packet may meet.
HWY_INLINE void open_node(const PatchBoxes& node, PatchPacket& packet) {
    PatchTraversal& walk = packet.walk;
    HWY_ALIGN float nears[kBoxChildren];
    std::uint32_t met = 0;
    ALHAZEN_UNROLL
    for (std::size_t half = 0; half < kBoxChildren; half += kLaneCount) {
        Floats near(walk.least), far(walk.most);
        ALHAZEN_UNROLL
        for (int axis = 0; axis < 3; ++axis) {
            const Floats slow(packet.inverse[0][axis]), fast(packet.inverse[1][axis]);
            const std::size_t down = packet.inverse[1][axis] < 0.0f ? 1 : 0;
            const Floats first = floats_of(node.planes[down][axis] + half);
            const Floats second = floats_of(node.planes[1 - down][axis] + half);
            const Floats step(node.step[axis]);
            const float begin = node.from[axis] - packet.from[1 - down][axis];
            const float end = node.from[axis] - packet.from[down][axis];
            const Floats in = first * step + Floats(begin), out = second * step + Floats(end);
            near = max_lanes(near, min_lanes(in * slow, in * fast));
            far = min_lanes(far, max_lanes(out * slow, out * fast));
        }
        met |= bits_of(near <= far) << half;
        store_lanes(near, nears + half);
    }
    push_children(node, nears, met & node.used, walk);
}

bool next_leaf_of_packet(const PatchBoxes* nodes, PatchPacket& packet, std::uint32_t& leaf,
                         float& near) {
    PatchTraversal& walk = packet.walk;
    while (walk.size > 0) {
        const PatchTraversal::Waiting next = walk.stack[--walk.size];
        if (next.near() > walk.most) continue;
        if ((next.child() & kLeafChild) != 0) {
            leaf = next.child() & ~kLeafChild;
            near = next.near();
            return true;
        }
        open_node(nodes[next.child()], packet);
    }
    return false;
}

bool next_leaf(const PatchBoxes* nodes, PatchTraversal& walk, std::uint32_t& leaf) {
    while (walk.size > 0) {
        const PatchTraversal::Waiting next = walk.stack[--walk.size];
        if (next.near() > walk.most) continue;
        if ((next.child() & kLeafChild) != 0) {
            leaf = next.child() & ~kLeafChild;
            return true;
        }
        open_node(nodes[next.child()], walk);
    }
    return false;
}

/// Advances the traversals by one node in turn, to hide latencies.
void next_leaves(const PatchBoxes* nodes, LineTraversal* const* ways, std::size_t count,
                 std::uint32_t* leaves) {
    constexpr std::size_t kTogether = 16;
    for (; count > kTogether; count -= kTogether, ways += kTogether, leaves += kTogether) {
        next_leaves(nodes, ways, kTogether, leaves);
    }
    std::uint32_t walking[kTogether], node[kTogether], met[kTogether];
    HWY_ALIGN float nears[kTogether][kBoxChildren];
    for (std::size_t k = 0; k < count; ++k) walking[k] = static_cast<std::uint32_t>(k);
    for (std::size_t left = count; left > 0;) {
        std::size_t opened = 0;
        for (std::size_t k = 0; k < left; ++k) {
            const std::uint32_t i = walking[k];
            PatchTraversal& walk = ways[i]->walk;
            PatchTraversal::Waiting next = walk.stack[--walk.size];
            while (next.near() > walk.most) next = walk.stack[--walk.size];
            // A leaf, or a node to open.
            leaves[i] = next.child() & ~kLeafChild;
            node[opened] = next.child();
            walking[opened] = i;
            opened += (next.child() & kLeafChild) == 0;
        }
        for (std::size_t k = 0; k < opened; ++k) {
            met[k] = test_node(nodes[node[k]], ways[walking[k]]->walk, nears[k]);
        }
        for (std::size_t k = 0; k < opened; ++k) {
            push_children(nodes[node[k]], nears[k], met[k], ways[walking[k]]->walk);
        }
        left = opened;
    }
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

HomogeneousValue bicubic(BezierView net, double u, double v) {
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

/// Origins and directions of eight lines.
struct LinePoints {
    Doubles x{0.0}, y{0.0}, z{0.0};

    HWY_INLINE LinePoints(const Doubles& px, const Doubles& py, const Doubles& pz)
        : x(px), y(py), z(pz) {}
    HWY_INLINE explicit LinePoints(const double (&p)[3][kRayLanes])
        : x(load_lanes(p[0])), y(load_lanes(p[1])), z(load_lanes(p[2])) {}
};
HWY_INLINE Doubles dot(const LinePoints& a, const LinePoints& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE LinePoints cross(const LinePoints& a, const LinePoints& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Minimum and maximum of eight.
HWY_INLINE void range_of(const Doubles& values, float& least, float& most) {
    HWY_ALIGN float x[kRayLanes];
    store_lanes(as_floats(values), x);
    least = most = x[0];
    for (std::size_t i = 1; i < kRayLanes; ++i) {
        least = x[i] < least ? x[i] : least;
        most = x[i] > most ? x[i] : most;
    }
}

/// Distances along the lines with a margin to the side, limited to the range of floats.
HWY_INLINE Doubles places(const Doubles& x, double side) {
    const Doubles wide = x + Doubles(side) * (Doubles(1e-5) + Doubles(1e-6) * abs(x));
    return min_lanes(max_lanes(wide, Doubles(-1e30)), Doubles(1e30));
}

bool begin_packet(const RayLanes& rays, const PatchFrame& frame, double far, PatchPacket& packet) {
    const LinePoints center(Doubles(frame.center.x), Doubles(frame.center.y),
                            Doubles(frame.center.z));
    const LinePoints d(rays.direction), from(rays.origin);
    const Doubles per_length = Doubles(1.0) / sqrt(dot(d, d)), zero(0.0), scale(frame.scale);
    const LinePoints direction(per_length * d.x, per_length * d.y, per_length * d.z);
    const LinePoints out(from.x - center.x, from.y - center.y, from.z - center.z);
    const Doubles ahead =
        select_lanes(dot(out, out) > Doubles(far * far), -dot(out, direction), zero);
    const Doubles* outs[3] = {&out.x, &out.y, &out.z};
    const Doubles* directions[3] = {&direction.x, &direction.y, &direction.z};
    bool together = true;
    for (int axis = 0; axis < 3; ++axis) {
        const Doubles& x = *directions[axis];
        const Doubles origin = scale * (*outs[axis] + ahead * x);
        store_lanes(origin, packet.origin[axis]);
        store_lanes(x, packet.direction[axis]);
        const Doubles size = max_lanes(abs(x), Doubles(1e-18));
        range_of(origin, packet.from[0][axis], packet.from[1][axis]);
        range_of(Doubles(1.0) / select_lanes(x < zero, -size, size), packet.inverse[0][axis],
                 packet.inverse[1][axis]);
        together = together && !(packet.inverse[0][axis] < 0.0f && packet.inverse[1][axis] > 0.0f);
    }
    const Doubles per_t = scale / per_length, shift = ahead * scale;
    const Doubles begin = places(load_lanes(rays.t_min) * per_t - shift, -1.0);
    const Doubles end = places(load_lanes(rays.t_max) * per_t - shift, 1.0);
    PatchTraversal& walk = packet.walk;
    float ignored = 0.0f;
    range_of(begin, walk.least, ignored);
    range_of(end, ignored, walk.most);
    store_lanes(as_floats(end), packet.most_of);
    walk.size = 1;
    walk.stack[0] = PatchTraversal::Waiting::of(walk.least, 0);
    return together;
}

/// `test_leaf` with a larger margin for rounding, as single lines are set up differently.
std::uint32_t lines_near(const PatchLeaf& leaf, const PatchPacket& packet) {
    const auto all = [](const Vec3& p) {
        return LinePoints(Doubles(p.x), Doubles(p.y), Doubles(p.z));
    };
    const LinePoints du = all(leaf.by_u()), dv = all(leaf.by_v()), center = all(leaf.middle());
    const LinePoints origin(packet.origin), direction(packet.direction);
    const LinePoints offset(origin.x - center.x, origin.y - center.y, origin.z - center.z);
    const LinePoints across_v = cross(dv, direction), across_u = cross(direction, du);
    const LinePoints normal = cross(du, dv);
    const Doubles size = abs(dot(normal, direction)), half(0.5), rounding(1e-13);
    const Doubles along_u = dot(across_v, offset), along_v = dot(across_u, offset);
    const Doubles bend_n(leaf.most_bend(2));
    const Doubles normal_u = abs(dot(across_u, normal)) * bend_n;
    const Doubles normal_v = abs(dot(across_v, normal)) * bend_n;
    const Doubles bend_u = size * Doubles(leaf.most_bend(0)) + normal_v;
    const Doubles bend_v = size * Doubles(leaf.most_bend(1)) + normal_u;
    return bits_of((abs(along_u) <= size + half * bend_u + rounding) &
                   (abs(along_v) <= size + half * bend_v + rounding));
}

#include "alhazen/shapes/patches/patch_halving-inl.h"
#include "alhazen/shapes/patches/patch_leaf_test-inl.h"
#include "alhazen/shapes/patches/patch_newton-inl.h"
// After `transpose_lanes`.
#include "alhazen/shapes/patches/patch_pairs-inl.h"

}  // namespace

const PatchKernels& patch_kernels_of_target() {
    static constexpr PatchKernels kernels{&next_leaf,           &next_leaves,  &begin_packet,
                                          &next_leaf_of_packet, &test_leaf,    &set_out_lines,
                                          &test_leaves,         &lines_near,   &bicubic,
                                          &cubic_line,          &cubic_newton, &cubic_newtons,
                                          &cubic_bounds,        &halve_cubic,  &cubic_part};
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(patch_kernels_of_target);

const PatchKernels& patch_kernels() {
    // Called for every ray: the dispatch is cached.
    return ALHAZEN_KERNEL(patch_kernels_of_target)();
}

}  // namespace alhazen
#endif
