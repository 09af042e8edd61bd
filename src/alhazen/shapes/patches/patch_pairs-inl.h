/// Four pairs of a line and a leaf in lanes: the leaf test, and Newton's method for bicubic patches
/// without weights; a fragment without a guard, included by patch_lanes.cpp in the namespace of
/// each instruction set.
///
/// Conventions: each pair performs the operations of `test_leaf`, `cubic_line` and `cubic_newton`
/// in the same order, and thus has their bits. `Point` has four lanes, doubles.

/// One vector for each pair.
struct PairVectors {
    Point x{0.0}, y{0.0}, z{0.0};

    HWY_INLINE PairVectors(const Point& px, const Point& py, const Point& pz)
        : x(px), y(py), z(pz) {}
};
HWY_INLINE Point dot(const PairVectors& a, const PairVectors& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE PairVectors cross(const PairVectors& a, const PairVectors& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Gathers vectors that have a fourth number, which is ignored.
HWY_INLINE PairVectors vectors_of(const double* const (&each)[kPatchPairs]) {
    Point rows[4], columns[4];
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) rows[i] = load_unaligned<4>(each[i]);
    transpose_lanes(rows, columns);
    return {columns[0], columns[1], columns[2]};
}

/// The inputs of `test_leaf` from four leaves.
struct PairLeaves {
    Point center[3], du[3], dv[3], bend[3], unit_u{0.0}, unit_v{0.0};

    HWY_INLINE explicit PairLeaves(const PatchLeaf* const (&leaves)[kPatchPairs]) {
#if HWY_TARGET != HWY_SCALAR  // the scalar target has no interleaving
        if constexpr (kParts<double, 4> == 1) {
            load_words(leaves);
            return;
        }
#endif
        HWY_ALIGN double numbers[14][4];
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < kPatchPairs; ++i) {
            const PatchLeaf& leaf = *leaves[i];
            ALHAZEN_UNROLL
            for (int k = 0; k < 3; ++k) {
                numbers[k][i] = leaf.center[k];
                numbers[3 + k][i] = leaf.du[k];
                numbers[6 + k][i] = leaf.dv[k];
                numbers[9 + k][i] = leaf.most_bend(k);
            }
            numbers[12][i] = leaf.unit_u();
            numbers[13][i] = leaf.unit_v();
        }
        ALHAZEN_UNROLL
        for (int k = 0; k < 3; ++k) {
            center[k] = load_lanes<4>(numbers[k]);
            du[k] = load_lanes<4>(numbers[3 + k]);
            dv[k] = load_lanes<4>(numbers[6 + k]);
            bend[k] = load_lanes<4>(numbers[9 + k]);
        }
        unit_u = load_lanes<4>(numbers[12]);
        unit_v = load_lanes<4>(numbers[13]);
    }

  private:
#if HWY_TARGET != HWY_SCALAR
    /// Transposes the leaves' first 32 bytes.
    HWY_INLINE void load_words(const PatchLeaf* const (&leaves)[kPatchPairs]) {
        static_assert(offsetof(PatchLeaf, center) == 0 && offsetof(PatchLeaf, du) == 12 &&
                      offsetof(PatchLeaf, dv) == 18 && offsetof(PatchLeaf, bend) == 24 &&
                      offsetof(PatchLeaf, exponent_u) == 30 &&
                      offsetof(PatchLeaf, exponent_v) == 31);
        using Tag = LaneTag<double, 4>;
        const Tag d;
        const hn::RebindToUnsigned<Tag> d64;
        const hn::RebindToSigned<Tag> di64;
        const hn::Rebind<std::uint32_t, Tag> d32;
        const hn::Rebind<std::int32_t, Tag> di32;
        const hn::Rebind<float, Tag> df;
        const double* each[kPatchPairs];
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < kPatchPairs; ++i) {
            each[i] = reinterpret_cast<const double*>(leaves[i]);
        }
        Point rows[4], columns[4];
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) rows[i] = load_unaligned<4>(each[i]);
        transpose_lanes(rows, columns);
        const auto word = [&](std::size_t k, bool high) {
            const auto both = hn::BitCast(d64, columns[k].part[0]);
            return high ? hn::TruncateTo(d32, hn::ShiftRight<32>(both)) : hn::TruncateTo(d32, both);
        };
        const auto set = [](Point& to, auto value) { to.part[0] = value; };
        const auto real = [&](auto bits) { return hn::PromoteTo(d, hn::BitCast(df, bits)); };
        const auto low_half = [&](auto bits) {
            return hn::PromoteTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(hn::BitCast(di32, bits))));
        };
        const auto high_half = [&](auto bits) {
            return hn::PromoteTo(d, hn::ShiftRight<16>(hn::BitCast(di32, bits)));
        };
        const auto power = [&](auto exponent) {
            const auto biased = hn::Add(hn::PromoteTo(di64, exponent), hn::Set(di64, 1023));
            return hn::BitCast(d, hn::ShiftLeft<52>(biased));
        };
        set(center[0], real(word(0, false)));
        set(center[1], real(word(0, true)));
        set(center[2], real(word(1, false)));
        const auto du_01 = word(1, true), du_2_dv_0 = word(2, false), dv_12 = word(2, true);
        set(du[0], low_half(du_01));
        set(du[1], high_half(du_01));
        set(du[2], low_half(du_2_dv_0));
        set(dv[0], high_half(du_2_dv_0));
        set(dv[1], low_half(dv_12));
        set(dv[2], high_half(dv_12));
        const auto bend_01 = word(3, false), last = word(3, true);
        set(bend[0], real(hn::ShiftLeft<16>(bend_01)));
        set(bend[1], real(hn::ShiftLeft<16>(hn::ShiftRight<16>(bend_01))));
        set(bend[2], real(hn::ShiftLeft<16>(last)));
        const auto exponents = hn::BitCast(di32, last);
        set(unit_u, power(hn::ShiftRight<24>(hn::ShiftLeft<8>(exponents))));
        set(unit_v, power(hn::ShiftRight<24>(exponents)));
    }
#endif
};

void test_leaves(const LeafPairs& pairs, LeafAnswers& out) {
    const PairLeaves leaf(pairs.leaf);
    const double *origins[kPatchPairs], *directions[kPatchPairs];
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kPatchPairs; ++i) {
        origins[i] = pairs.line[i]->origin;
        directions[i] = pairs.line[i]->direction;
    }
    const PairVectors origin = vectors_of(origins), direction = vectors_of(directions);
    const PairVectors du(leaf.unit_u * leaf.du[0], leaf.unit_u * leaf.du[1],
                         leaf.unit_u * leaf.du[2]);
    const PairVectors dv(leaf.unit_v * leaf.dv[0], leaf.unit_v * leaf.dv[1],
                         leaf.unit_v * leaf.dv[2]);
    const PairVectors offset(origin.x - leaf.center[0], origin.y - leaf.center[1],
                             origin.z - leaf.center[2]);
    const PairVectors across_v = cross(dv, direction), across_u = cross(direction, du);
    const PairVectors normal = cross(du, dv);
    const Point det = dot(normal, direction), size = abs(det);
    const Point along_u = dot(across_v, offset), along_v = dot(across_u, offset);
    const Point height = dot(normal, offset);
    const Point &bend_x = leaf.bend[0], &bend_y = leaf.bend[1], &bend_z = leaf.bend[2];
    const Point bend_u = size * bend_x + abs(dot(across_v, normal)) * bend_z;
    const Point bend_v = size * bend_y + abs(dot(across_u, normal)) * bend_z;
    const Point half(0.5), rounding(1e-14), zero(0.0);
    const auto outside = (abs(along_u) > size + half * bend_u + rounding) |
                         (abs(along_v) > size + half * bend_v + rounding);
    const Point plane = select_lanes(det < zero, height, -height);
    const Point thick = half * bend_z * dot(normal, normal) + rounding;
    const auto beyond = (plane - thick > load_lanes<4>(pairs.most) * size) |
                        (plane + thick < load_lanes<4>(pairs.least) * size);
    const Point bend = select_lanes(bend_u > bend_v, bend_u, bend_v);
    constexpr double kLength = PatchLeaf::kMostLength;
    const Point most_u = Point(kLength) * leaf.unit_u, most_v = Point(kLength) * leaf.unit_v;
    store_lanes(bend_x * most_u + bend_y * most_v + bend_z * most_u * most_v, out.bend);
    store_lanes(along_u / det, out.a);
    store_lanes(along_v / det, out.b);
    out.met = ~bits_of(outside | beyond);
    out.unique = bits_of(bend < Point(kUnique) * size);
    out.certified = bits_of(bend <= Point(kCertified) * size);
}

/// Stores to any address.
HWY_INLINE void store_unaligned(const Point& p, double* to) {
    const LaneTag<double, 4> d;
    for (std::size_t i = 0; i < kParts<double, 4>; ++i) {
        hn::StoreU(p.part[i], d, to + i * hn::Lanes(d));
    }
}
/// Writes three vectors of each of four lines, with a fourth number.
HWY_INLINE void store_vectors(const PairVectors& p, const Point& fourth, double* const* to) {
    const Point columns[4] = {p.x, p.y, p.z, fourth};
    Point rows[4];
    transpose_lanes(columns, rows);
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) store_unaligned(rows[i], to[i]);
}

/// Combines PatchIndex::line_of, add_axes, walk_of and leaf_line.
LinesSetOut set_out_lines(const Ray* const* rays, const LineFrame& in, LineTraversal* ways) {
    static_assert(offsetof(Ray, direction) == 24 && offsetof(Ray, t_min) == 48);
    Point rows[4], low[4], high[4];
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) rows[i] = load_unaligned<4>(&rays[i]->origin.x);
    transpose_lanes(rows, low);
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) rows[i] = load_unaligned<4>(&rays[i]->direction.y);
    transpose_lanes(rows, high);
    const PairVectors from(low[0], low[1], low[2]), along(low[3], high[0], high[1]);
    const Point square = dot(along, along), one(1.0), zero(0.0);
    const Point size = sqrt(square);
    const PairVectors d(along.x / size, along.y / size, along.z / size);
    const Point per_length = one / size;
    const Vec3& center = in.frame.center;
    const Point scale(in.frame.scale);
    const PairVectors to_center(Point(center.x) - from.x, Point(center.y) - from.y,
                                Point(center.z) - from.z);
    const auto is_far = sqrt(dot(to_center, to_center)) > Point(in.far);
    const Point distance = dot(to_center, d);
    const PairVectors o(select_lanes(is_far, from.x + distance * d.x, from.x),
                        select_lanes(is_far, from.y + distance * d.y, from.y),
                        select_lanes(is_far, from.z + distance * d.z, from.z));
    const Point shift = select_lanes(is_far, distance * per_length, zero);
    const Point tiny = Point(0x1p-46) * (Point(in.reach) + Point(in.most_weight) * sqrt(dot(o, o)));
    const PairVectors seen(scale * (o.x - Point(center.x)), scale * (o.y - Point(center.y)),
                           scale * (o.z - Point(center.z)));
    const Point sign = copysign(one, d.z), a = -one / (sign + d.z);
    const PairVectors ax(one + sign * d.x * d.x * a, sign * d.x * d.y * a, -sign * d.x);
    const PairVectors ay = cross(d, ax);
    // The parts of PatchLine and LeafLine four numbers at a time.
    static_assert(offsetof(PatchLine, origin) == 0 && offsetof(PatchLine, axis_y) == 72 &&
                  offsetof(PatchLine, shift) == 96 && offsetof(PatchLine, tiny) == 112 &&
                  offsetof(LeafLine, direction) == 32);
    double* to[4];
    const auto put = [&](std::size_t place, const PairVectors& p, const Point& fourth) {
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) to[i] = &ways[i].line.origin.x + place;
        store_vectors(p, fourth, to);
    };
    put(0, o, d.x);
    put(4, {d.y, d.z, ax.x}, ax.y);
    put(8, {ax.z, ay.x, ay.y}, ay.z);
    put(11, {ay.z, shift, per_length}, tiny);
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) to[i] = ways[i].seen_by.origin;
    store_vectors(seen, zero, to);
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) to[i] = ways[i].seen_by.direction;
    store_vectors(d, zero, to);
    HWY_ALIGN float numbers[8][4];
    const auto inverse = [&](const Point& x) {
        return one / copysign(max_lanes(abs(x), Point(1e-18)), x);
    };
    const auto place = [&](const Point& t, double side) {
        const Point x = (t - shift) * (scale / per_length);
        const Point wide = x + Point(side) * (Point(1e-5) + Point(1e-6) * abs(x));
        return min_lanes(max_lanes(wide, Point(-1e30)), Point(1e30));
    };
    const Point each[8] = {seen.x,
                           seen.y,
                           seen.z,
                           inverse(d.x),
                           inverse(d.y),
                           inverse(d.z),
                           place(high[2], -1.0),
                           place(high[3], 1.0)};
    ALHAZEN_UNROLL
    for (std::size_t k = 0; k < 8; ++k) store_lanes(as_floats(each[k]), numbers[k]);
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) {
        PatchTraversal& walk = ways[i].walk;
        ALHAZEN_UNROLL
        for (std::size_t k = 0; k < 3; ++k) {
            walk.from[k] = numbers[k][i];
            walk.inverse[k] = numbers[3 + k][i];
        }
        walk.least = numbers[6][i];
        walk.most = numbers[7][i];
        walk.set_planes();
        walk.begin_above_end();
    }
    const auto usual = (square > Point(1e-200)) & (square < Point(1e200));
    const auto is_near = (tiny <= Point(0x1p-20 * in.reach)) & (dot(d, d) > Point(0.5));
    return {bits_of(usual), bits_of(is_near)};
}

/// The control points of four patches along three axes.
struct PairNets {
    Point x[16], y[16], z[16];

    HWY_INLINE explicit PairNets(const CubicPairs& pairs) {
        Point rows[4], first[4], second[4], third[4];
        const auto columns_at = [&](std::size_t place, Point(&columns)[4]) {
            ALHAZEN_UNROLL
            for (std::size_t i = 0; i < 4; ++i) {
                rows[i] = load_unaligned<4>(&pairs.line[i]->origin.x + place);
            }
            transpose_lanes(rows, columns);
        };
        columns_at(0, first);
        columns_at(4, second);
        columns_at(8, third);
        const PairVectors o(first[0], first[1], first[2]), d(first[3], second[0], second[1]);
        const PairVectors ax(second[2], second[3], third[0]), ay(third[1], third[2], third[3]);
        for (std::size_t k = 0; k < 16; ++k) {
            Point columns[4];
            ALHAZEN_UNROLL
            for (std::size_t i = 0; i < 4; ++i) {
                rows[i] = load_unaligned<4>(&pairs.points[i][k].x);
            }
            transpose_lanes(rows, columns);
            const PairVectors p(columns[0] - columns[3] * o.x, columns[1] - columns[3] * o.y,
                                columns[2] - columns[3] * o.z);
            x[k] = dot(ax, p);
            y[k] = dot(ay, p);
            z[k] = dot(d, p);
        }
    }
};

/// Bernstein polynomials of degree 3 and their derivatives.
struct PairBasis {
    Point value[4], slope[4];

    HWY_INLINE explicit PairBasis(const Point& t) {
        const Point s = Point(1.0) - t, three(3.0), six(6.0), none(0.0);
        const Point ss = s * s, st = s * t, tt = t * t;
        value[0] = ss * s;
        value[1] = three * (ss * t);
        value[2] = three * (st * t);
        value[3] = tt * t;
        slope[0] = none * ss - three * ss;
        slope[1] = three * ss - six * st;
        slope[2] = six * st - three * tt;
        slope[3] = three * tt - none * tt;
    }
};
HWY_INLINE Point sum_of(const Point (&weights)[4], const Point& a, const Point& b, const Point& c,
                        const Point& d) {
    return (weights[0] * a + weights[1] * b) + (weights[2] * c + weights[3] * d);
}
/// Sums over the rows of a net.
struct PairRow {
    Point at[4];

    HWY_INLINE PairRow(const Point (&weights)[4], const Point (&net)[16]) {
        ALHAZEN_UNROLL
        for (std::size_t k = 0; k < 4; ++k) {
            at[k] = sum_of(weights, net[k], net[4 + k], net[8 + k], net[12 + k]);
        }
    }
    [[nodiscard]] HWY_INLINE Point sum(const Point (&weights)[4]) const {
        return (at[0] * weights[0] + at[1] * weights[1]) +
               (at[2] * weights[2] + at[3] * weights[3]);
    }
};

void cubic_newtons(const CubicPairs& pairs, CubicRoots& out) {
    const auto larger = [](const Point& a, const Point& b) { return select_lanes(a > b, a, b); };
    const PairNets net(pairs);
    const Point u0 = load_lanes<4>(pairs.u0), u1 = load_lanes<4>(pairs.u1);
    const Point v0 = load_lanes<4>(pairs.v0), v1 = load_lanes<4>(pairs.v1);
    const Point width_u = u1 - u0, width_v = v1 - v0, one(1.0);
    const Point per_u = one / width_u, per_v = one / width_v;
    const Point margin_u = Point(kCellMargin) * width_u, margin_v = Point(kCellMargin) * width_v;
    const Point least_u = u0 - margin_u, most_u = u1 + margin_u;
    const Point least_v = v0 - margin_v, most_v = v1 + margin_v;
    const Point least = load_lanes<4>(pairs.least), most = load_lanes<4>(pairs.most);
    const Point bend3 = Point(3.0) * load_lanes<4>(pairs.bend);
    Point u = load_lanes<4>(pairs.u), v = load_lanes<4>(pairs.v), last(1.0);
    double reach = 0.25 * kCertified + kCellMargin;
    std::uint32_t active = pairs.used, ranged = pairs.ranged & active;
    out.met = 0;
    for (int step = 0; step < 40; ++step) {
        const Point far_u = Point(reach) * width_u, far_v = Point(reach) * width_v;
        active &=
            bits_of((u >= u0 - far_u) & (u <= u1 + far_u) & (v >= v0 - far_v) & (v <= v1 + far_v));
        if (active == 0) return;
        const auto clamped = [](const Point& x, const Point& low, const Point& high) {
            return select_lanes(x < low, low, select_lanes(x > high, high, x));
        };
        u = clamped(u, least_u, most_u);
        v = clamped(v, least_v, most_v);
        const PairBasis at_u(u), at_v(v);
        const PairRow x(at_u.value, net.x), y(at_u.value, net.y);
        const Point f_x = x.sum(at_v.value), f_y = y.sum(at_v.value);
        const Point x_v = x.sum(at_v.slope), y_v = y.sum(at_v.slope);
        const Point x_u = PairRow(at_u.slope, net.x).sum(at_v.value);
        const Point y_u = PairRow(at_u.slope, net.y).sum(at_v.value);
        const Point det = x_u * y_v - x_v * y_u, inverse = one / det;
        const Point du = (x_v * f_y - f_x * y_v) * inverse;
        const Point dv = (f_x * y_u - x_u * f_y) * inverse;
        u = u + du;
        v = v + dv;
        reach = 0.7 * reach > kCellMargin ? 0.7 * reach : kCellMargin;
        const Point moved = larger(abs(du) * per_u, abs(dv) * per_v);
        const std::uint32_t stalled =
            pairs.converges & bits_of((last < Point(0x1p-4)) & (moved > Point(0.25) * last));
        last = moved;
        const std::uint32_t done = active & (stalled | bits_of(moved <= Point(0x1p-23)));
        ranged &= active;
        if ((done | ranged) == 0) continue;
        const PairRow z_row(at_u.value, net.z);
        const Point z_u = PairRow(at_u.slope, net.z).sum(at_v.value);
        const Point z_v = z_row.sum(at_v.slope);
        const Point z = z_row.sum(at_v.value) + du * z_u + dv * z_v;
        if (done != 0) {
            const auto mask = lanes_of_bits<double, 4>(done);
            const auto keep = [&](const Point& value, double(&to)[kPatchPairs]) {
                store_lanes(select_lanes(mask, value, load_lanes<4>(to)), to);
            };
            keep(u, out.u);
            keep(v, out.v);
            keep(z, out.z);
            keep(x_u, out.x_u);
            keep(y_u, out.y_u);
            keep(x_v, out.x_v);
            keep(y_v, out.y_v);
            out.met |= done;
            active &= ~done;
        }
        // See `cubic_newton`.
        const Point bent = bend3 * moved * moved * (abs(x_u) + abs(y_u) + abs(z_u)) *
                           (abs(x_v) + abs(y_v) + abs(z_v));
        const Point beyond = larger(z - most, least - z) * abs(det);
        active &= ~(ranged & bits_of(beyond > bent));
        ranged &= bits_of(beyond > -bent);
        if (active == 0) return;
    }
}
