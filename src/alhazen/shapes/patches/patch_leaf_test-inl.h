/// The test of a leaf of a patch against a line; a fragment without a guard, included by
/// patch_lanes.cpp in the namespace of each instruction set.
///
/// Conventions: `Point` has four lanes, doubles. Vectors take three lanes; the fourth is any finite
/// number, and zero in cross products.

/// Reads one number past the third.
HWY_INLINE Point vector_of(const std::int16_t* three) {
    const LaneTag<double, 4> d;
    const hn::Rebind<std::int32_t, LaneTag<double, 4>> d32;
    const hn::Rebind<std::int16_t, LaneTag<double, 4>> d16;
    Point r(0.0);
    for (std::size_t i = 0; i < kParts<double, 4>; ++i) {
        const auto part = hn::LoadU(d16, three + i * hn::Lanes(d));
        r.part[i] = hn::PromoteTo(d, hn::PromoteTo(d32, part));
    }
    return r;
}
HWY_INLINE Point vector_of(const float* three) {
    HWY_ALIGN static constexpr double kPlace[4] = {0, 1, 2, 3};
    const LaneTag<double, 4> d;
    const hn::Rebind<float, LaneTag<double, 4>> df;
    Point r(0.0);
    for (std::size_t i = 0; i < kParts<double, 4>; ++i) {
        r.part[i] = hn::PromoteTo(d, hn::LoadU(df, three + i * hn::Lanes(d)));
    }
    // The fourth may be any value.
    return select_lanes(load_lanes<4>(kPlace) < Point(2.5), r, Point(0.0));
}

/// The permutation (y, z, x).
HWY_INLINE Point rotated(const Point& a) {
    Point r(0.0);
#if HWY_TARGET != HWY_SCALAR  // the scalar target has no table lookup
    if constexpr (kParts<double, 4> == 1) {
        HWY_ALIGN static constexpr std::int64_t kPlace[4] = {1, 2, 0, 3};
        const LaneTag<double, 4> d;
        const hn::RebindToSigned<LaneTag<double, 4>> di;
        r.part[0] = hn::TableLookupLanes(a.part[0], hn::IndicesFromVec(d, hn::Load(di, kPlace)));
        return r;
    }
#endif
    HWY_ALIGN double x[4];
    store_lanes(a, x);
    HWY_ALIGN const double turned[4] = {x[1], x[2], x[0], x[3]};
    return load_lanes<4>(turned);
}

/// A vector and its cyclic permutations, for cross products.
struct Turned {
    Point a, next;

    HWY_INLINE explicit Turned(const Point& p) : a(p), next(rotated(p)) {}
};
HWY_INLINE Point cross(const Turned& p, const Turned& q) {
    return rotated(p.a * q.next - p.next * q.a);
}

LeafAnswer test_leaf(const PatchLeaf& leaf, const LeafLine& line, double least, double most,
                     LeafStart& start) {
    const auto size_of = [](double x) { return x < 0.0 ? -x : x; };
    const auto larger = [](double a, double b) { return a > b ? a : b; };
    const Turned du(Point(leaf.unit_u()) * vector_of(leaf.du));
    const Turned dv(Point(leaf.unit_v()) * vector_of(leaf.dv));
    const Turned direction(load_lanes<4>(line.direction));
    const Point offset = load_lanes<4>(line.origin) - vector_of(leaf.center);
    const Point across_v = cross(dv, direction), across_u = cross(direction, du);
    const Point normal = cross(du, dv);
    HWY_ALIGN double along[4], bends[4];
    store_lanes(
        sum_of_each(normal * direction.a, across_v * offset, across_u * offset, normal * offset),
        along);
    store_lanes(sum_of_each(across_u * normal, across_v * normal, normal * normal, Point(0.0)),
                bends);
    const double det = along[0], size = size_of(det);
    const double bend_x = leaf.most_bend(0), bend_y = leaf.most_bend(1), bend_z = leaf.most_bend(2);
    const double bend_u = size * bend_x + size_of(bends[1]) * bend_z;
    const double bend_v = size * bend_y + size_of(bends[0]) * bend_z;
    // For the rounding of cross products with cancellation; all vectors are shorter than 8.
    constexpr double kRounding = 1e-14;
    if (size_of(along[1]) > size + 0.5 * bend_u + kRounding ||
        size_of(along[2]) > size + 0.5 * bend_v + kRounding) {
        return LeafAnswer::None;
    }
    // The distance of the leaf's plane times `size`, and the extent of the leaf around it.
    const double plane = det < 0.0 ? along[3] : -along[3];
    const double thick = 0.5 * bend_z * bends[2] + kRounding;
    if (plane - thick > most * size || plane + thick < least * size) return LeafAnswer::None;
    const double bend = larger(bend_u, bend_v);
    const double most_u = leaf.most_u(), most_v = leaf.most_v();
    start.bend = bend_x * most_u + bend_y * most_v + bend_z * most_u * most_v;
    if (!(bend < kUnique * size)) return LeafAnswer::Divide;
    start.a = along[1] / det;
    start.b = along[2] / det;
    return bend <= kCertified * size ? LeafAnswer::Certified : LeafAnswer::Unique;
}
