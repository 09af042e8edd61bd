/// Bounds, halves and parts of bicubic cells in the plane of a line; a fragment without a guard,
/// included by patch_lanes.cpp in the namespace of each instruction set.
///
/// Conventions: `Point` has four lanes, doubles.

/// Transposes a 4 x 4 matrix.
HWY_INLINE void transpose_lanes(const Lanes<double, 4> (&rows)[4], Lanes<double, 4> (&columns)[4]) {
#if HWY_TARGET != HWY_SCALAR  // the scalar target has no interleaving
    if constexpr (kParts<double, 4> == 1) {
        const LaneTag<double, 4> tag;
        const auto r0 = rows[0].part[0], r1 = rows[1].part[0];
        const auto r2 = rows[2].part[0], r3 = rows[3].part[0];
        const auto even_01 = hn::InterleaveLower(tag, r0, r1);
        const auto even_23 = hn::InterleaveLower(tag, r2, r3);
        const auto odd_01 = hn::InterleaveUpper(tag, r0, r1);
        const auto odd_23 = hn::InterleaveUpper(tag, r2, r3);
        columns[0].part[0] = hn::ConcatLowerLower(tag, even_23, even_01);
        columns[1].part[0] = hn::ConcatLowerLower(tag, odd_23, odd_01);
        columns[2].part[0] = hn::ConcatUpperUpper(tag, even_23, even_01);
        columns[3].part[0] = hn::ConcatUpperUpper(tag, odd_23, odd_01);
        return;
    }
#endif
    HWY_ALIGN double from[4][4], to[4][4];
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) store_lanes(rows[i], from[i]);
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) {
        ALHAZEN_UNROLL
        for (std::size_t k = 0; k < 4; ++k) to[k][i] = from[i][k];
    }
    ALHAZEN_UNROLL
    for (std::size_t k = 0; k < 4; ++k) columns[k] = load_lanes<4>(to[k]);
}

/// Four rows of control points in lanes, and the rows shifted by one and by two along v.
struct CubicRows {
    Point row[4], by_one[4], by_two[4];

    HWY_INLINE explicit CubicRows(const double* at) {
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) {
            row[i] = load_lanes<4>(at + 4 * i);
            by_one[i] = load_unaligned<4>(at + 4 * i + 1);
            by_two[i] = load_unaligned<4>(at + 4 * i + 2);
        }
    }
};

HWY_INLINE Point most_of(const Point (&x)[4]) {
    return max_lanes(max_lanes(x[0], x[1]), max_lanes(x[2], x[3]));
}
HWY_INLINE Point least_of(const Point (&x)[4]) {
    return min_lanes(min_lanes(x[0], x[1]), min_lanes(x[2], x[3]));
}

/// Maximum of differences, as they are and solved for u and v.
struct Largest {
    Point size, u, v;
    Point ux, uy, vx, vy, keep;

    HWY_INLINE Largest() : size(0.0), u(0.0), v(0.0) {}
    HWY_INLINE void include(const Point& x, const Point& y) {
        size = max_lanes(size, keep * (abs(x) + abs(y)));
        u = max_lanes(u, keep * abs(ux * x + uy * y));
        v = max_lanes(v, keep * abs(vx * x + vy * y));
    }
};

/// The value at the middle and the derivatives, in half-widths.
HWY_INLINE void middle_of(const CubicRows& x, const CubicRows& y, CellBounds& out) {
    HWY_ALIGN static constexpr double kValue[4] = {0.125, 0.375, 0.375, 0.125};
    HWY_ALIGN static constexpr double kSlope[4] = {-0.375, -0.375, 0.375, 0.375};
    const Point value = load_lanes<4>(kValue), slope = load_lanes<4>(kSlope);
    const Point one(0.125), three(0.375);
    const auto at = [&](const CubicRows& rows) {
        return (one * rows.row[0] + three * rows.row[1]) +
               (three * rows.row[2] + one * rows.row[3]);
    };
    const auto rise = [&](const CubicRows& rows) {
        return three * ((rows.row[3] - rows.row[0]) + (rows.row[2] - rows.row[1]));
    };
    const Point at_x = at(x), at_y = at(y), none(0.0);
    HWY_ALIGN double sums[4];
    store_lanes(sum_of_each(value * at_x, value * at_y, slope * at_x, slope * at_y), sums);
    out.f = {sums[0], sums[1]};
    out.f_v = {sums[2], sums[3]};
    store_lanes(sum_of_each(value * rise(x), value * rise(y), none, none), sums);
    out.f_u = {sums[0], sums[1]};
}

void cubic_bounds(const CubicCell& net, double margin, CellBounds& out) {
    const CubicRows x(net.x), y(net.y);
    HWY_ALIGN double most[4];
    // The range of an axis is [-most[k + 1], most[k]]; true if it excludes the origin.
    const auto is_beside = [&](int axis, std::size_t k) {
        out.most[axis] = most[k];
        out.least[axis] = -most[k + 1];
        return out.least[axis] > margin || out.most[axis] < -margin;
    };
    store_lanes(largest_of_each(most_of(x.row), -least_of(x.row), most_of(y.row), -least_of(y.row)),
                most);
    if (is_beside(0, 0) || is_beside(1, 2)) return;
    middle_of(x, y, out);
    const auto size_of = [](const PlanePoint& p) {
        return (p.x < 0 ? -p.x : p.x) + (p.y < 0 ? -p.y : p.y);
    };
    const PlanePoint along = size_of(out.f_u) > size_of(out.f_v) ? out.f_u : out.f_v;
    const double scale = size_of(along);
    const Point ax(scale > 0.0 ? -along.y / scale : 0.5), ay(scale > 0.0 ? along.x / scale : 0.5);
    Point aside[4];
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) aside[i] = x.row[i] * ax + y.row[i] * ay;
    HWY_ALIGN static constexpr double kKeep[3][4] = {{1, 1, 1, 1}, {1, 1, 1, 0}, {1, 1, 0, 0}};
    const Point keep_1 = load_lanes<4>(kKeep[1]);
    Point u_x[3], u_y[3], v_x[4], v_y[4], extent_u(0.0), extent_v(0.0);  // first differences
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) {
        v_x[i] = x.by_one[i] - x.row[i];
        v_y[i] = y.by_one[i] - y.row[i];
        extent_v = max_lanes(extent_v, keep_1 * (abs(v_x[i]) + abs(v_y[i])));
        if (i == 3) break;
        u_x[i] = x.row[i + 1] - x.row[i];
        u_y[i] = y.row[i + 1] - y.row[i];
        extent_u = max_lanes(extent_u, abs(u_x[i]) + abs(u_y[i]));
    }
    store_lanes(largest_of_each(most_of(aside), -least_of(aside), extent_u, extent_v), most);
    if (is_beside(2, 0)) return;
    out.extent_u = most[2];
    out.extent_v = most[3];
    const double det = out.f_u.x * out.f_v.y - out.f_u.y * out.f_v.x;
    const double inverse = det != 0.0 ? 1.0 / det : 0.0;
    Largest uu, uv, vv;
    for (Largest* to : {&uu, &uv, &vv}) {
        to->ux = Point(inverse * out.f_v.y);
        to->uy = Point(-inverse * out.f_v.x);
        to->vx = Point(-inverse * out.f_u.y);
        to->vy = Point(inverse * out.f_u.x);
    }
    uu.keep = load_lanes<4>(kKeep[0]);
    uv.keep = keep_1;
    vv.keep = load_lanes<4>(kKeep[2]);
    const Point two(2.0);
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) {
        vv.include(x.by_two[i] - two * x.by_one[i] + x.row[i],
                   y.by_two[i] - two * y.by_one[i] + y.row[i]);
        if (i < 3) uv.include(v_x[i + 1] - v_x[i], v_y[i + 1] - v_y[i]);
        if (i < 2) uu.include(u_x[i + 1] - u_x[i], u_y[i + 1] - u_y[i]);
    }
    const Largest* all[3] = {&uu, &uv, &vv};
    double* sizes[3] = {&out.size_uu, &out.size_uv, &out.size_vv};
    ALHAZEN_UNROLL
    for (int k = 0; k < 3; ++k) {
        store_lanes(largest_of_each(all[k]->size, all[k]->u, all[k]->v, all[k]->v), most);
        *sizes[k] = most[0];
        out.bend_u[k] = most[1];
        out.bend_v[k] = most[2];
    }
}

/// Halves four curves, given by their four control points in lanes.
HWY_INLINE void halve_rows(const Point (&p)[4], Point (&low)[4], Point (&high)[4]) {
    const Point half(0.5);
    const Point a = half * (p[0] + p[1]), b = half * (p[1] + p[2]), c = half * (p[2] + p[3]);
    low[0] = p[0];
    low[1] = a;
    low[2] = half * (a + b);
    high[1] = half * (b + c);
    high[2] = c;
    high[3] = p[3];
    low[3] = high[0] = half * (low[2] + high[1]);
}

template <bool kAlongU>
HWY_INLINE void halve_coordinate(const double* from, double* to_low, double* to_high) {
    Point p[4], low[4], high[4];
    if constexpr (kAlongU) {
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) p[i] = load_lanes<4>(from + 4 * i);
        halve_rows(p, low, high);
    } else {
        Point columns[4], others[4];
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) columns[i] = load_lanes<4>(from + 4 * i);
        transpose_lanes(columns, p);
        halve_rows(p, columns, others);
        transpose_lanes(columns, low);
        transpose_lanes(others, high);
    }
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) {
        store_lanes(low[i], to_low + 4 * i);
        store_lanes(high[i], to_high + 4 * i);
    }
}

void halve_cubic(const CubicCell& net, bool along_u, CubicCell& low, CubicCell& high) {
    const auto halve = along_u ? &halve_coordinate<true> : &halve_coordinate<false>;
    halve(net.x, low.x, high.x);
    halve(net.y, low.y, high.y);
    store_lanes(Point(0.0), low.rest);
    store_lanes(Point(0.0), high.rest);
}

/// The control points over [from, to] as weighted sums of those over [0, 1] (blossoms). All weights
/// are positive and sum to 1.
struct CubicPart {
    double weights[4][4];  ///< [of the part][of the whole]

    HWY_INLINE CubicPart(double from, double to) {
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) {
            const double a = i > 2 ? to : from, b = i > 1 ? to : from, c = i > 0 ? to : from;
            const double p = 1.0 - a, q = 1.0 - b, r = 1.0 - c;
            weights[i][0] = p * q * r;
            weights[i][1] = a * q * r + p * b * r + p * q * c;
            weights[i][2] = a * b * r + a * q * c + p * b * c;
            weights[i][3] = a * b * c;
        }
    }
};

HWY_INLINE void part_of_rows(const CubicPart& part, const Point (&p)[4], Point (&out)[4]) {
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) {
        const double(&w)[4] = part.weights[i];
        out[i] =
            (Point(w[0]) * p[0] + Point(w[1]) * p[1]) + (Point(w[2]) * p[2] + Point(w[3]) * p[3]);
    }
}

void cubic_part(const CubicLine& whole, const PatchCell& cell, CubicCell& part) {
    const CubicPart along_u(cell.u0, cell.u1), along_v(cell.v0, cell.v1);
    const auto take = [&](const double* from, double* to) {
        Point p[4], rows[4], columns[4];
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) p[i] = load_lanes<4>(from + 4 * i);
        part_of_rows(along_u, p, rows);
        transpose_lanes(rows, columns);
        part_of_rows(along_v, columns, p);
        transpose_lanes(p, rows);
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) store_lanes(rows[i], to + 4 * i);
    };
    take(whole.x, part.x);
    take(whole.y, part.y);
    store_lanes(Point(0.0), part.rest);
}
