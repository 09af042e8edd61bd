/// Bounds, halves and parts of bicubic cells in the plane of a line; a fragment without a guard,
/// included by patch_lanes.cpp in the namespace of each instruction set.
///
/// Conventions: `Point` has four lanes, doubles.

/// Four rows of control points in lanes, and the same moved by one and two along v.
struct CubicRows {
    Point row[4], by_one[4], by_two[4];

    HWY_INLINE explicit CubicRows(const double* at) {
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

/// Keeps the largest of differences, as they are and solved for u and v.
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

void cubic_bounds(const PlaneNet& net, double margin, CellBounds& out) {
    // Two rows' ends are read beyond the last.
    HWY_ALIGN double xs[20], ys[20];
    for (std::size_t k = 0; k < 16; ++k) {
        xs[k] = net.at[k].x;
        ys[k] = net.at[k].y;
    }
    for (std::size_t k = 16; k < 20; ++k) xs[k] = ys[k] = 0.0;
    const CubicRows x(xs), y(ys);
    HWY_ALIGN double most[4];
    // Ends of the range of an axis in most[k] and -most[k + 1]; whether it leaves out the origin.
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
    for (std::size_t i = 0; i < 4; ++i) aside[i] = x.row[i] * ax + y.row[i] * ay;
    HWY_ALIGN static constexpr double kKeep[3][4] = {{1, 1, 1, 1}, {1, 1, 1, 0}, {1, 1, 0, 0}};
    const Point keep_1 = load_lanes<4>(kKeep[1]);
    Point u_x[3], u_y[3], v_x[4], v_y[4], extent_u(0.0), extent_v(0.0);  // first differences
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
    for (std::size_t i = 0; i < 4; ++i) {
        vv.include(x.by_two[i] - two * x.by_one[i] + x.row[i],
                   y.by_two[i] - two * y.by_one[i] + y.row[i]);
        if (i < 3) uv.include(v_x[i + 1] - v_x[i], v_y[i + 1] - v_y[i]);
        if (i < 2) uu.include(u_x[i + 1] - u_x[i], u_y[i + 1] - u_y[i]);
    }
    const Largest* all[3] = {&uu, &uv, &vv};
    double* sizes[3] = {&out.size_uu, &out.size_uv, &out.size_vv};
    for (int k = 0; k < 3; ++k) {
        store_lanes(largest_of_each(all[k]->size, all[k]->u, all[k]->v, all[k]->v), most);
        *sizes[k] = most[0];
        out.bend_u[k] = most[1];
        out.bend_v[k] = most[2];
    }
}

/// Halves of four points `stride` apart, `width` doubles each; by midpoints as everywhere.
template <std::size_t kWidth>
HWY_INLINE void halve_four(const double* from, std::size_t stride, double* low, double* high) {
    using Row = Lanes<double, kWidth>;
    const Row half(0.5);
    const Row p0 = load_unaligned<kWidth>(from), p1 = load_unaligned<kWidth>(from + stride);
    const Row p2 = load_unaligned<kWidth>(from + 2 * stride);
    const Row p3 = load_unaligned<kWidth>(from + 3 * stride);
    const Row a = half * (p0 + p1), b = half * (p1 + p2), c = half * (p2 + p3);
    const Row ab = half * (a + b), bc = half * (b + c), middle = half * (ab + bc);
    HWY_ALIGN double out[7][kWidth];
    store_lanes(p0, out[0]);
    store_lanes(a, out[1]);
    store_lanes(ab, out[2]);
    store_lanes(middle, out[3]);
    store_lanes(bc, out[4]);
    store_lanes(c, out[5]);
    store_lanes(p3, out[6]);
    for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t i = 0; i < kWidth; ++i) {
            low[k * stride + i] = out[k][i];
            high[k * stride + i] = out[k + 3][i];
        }
    }
}

void halve_cubic(const PlaneNet& net, bool along_u, PlaneNet& low, PlaneNet& high) {
    low.degree_u = low.degree_v = high.degree_u = high.degree_v = 3;
    const double* from = &net.at[0].x;
    double *to_low = &low.at[0].x, *to_high = &high.at[0].x;
    if (along_u) {
        halve_four<8>(from, 8, to_low, to_high);
    } else {
        for (std::size_t i = 0; i < 4; ++i) {
            halve_four<2>(from + 8 * i, 2, to_low + 8 * i, to_high + 8 * i);
        }
    }
}

/// The control points over [from, to] as sums of those over [0, 1]: blossoms. All terms are
/// positive and their sum is 1.
struct CubicPart {
    double weights[4][4];  ///< [of the part][of the whole]

    HWY_INLINE CubicPart(double from, double to) {
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

template <std::size_t kWidth>
HWY_INLINE void part_of_four(const CubicPart& part, const double* from, std::size_t stride,
                             double* to) {
    using Row = Lanes<double, kWidth>;
    const Row p0 = load_unaligned<kWidth>(from), p1 = load_unaligned<kWidth>(from + stride);
    const Row p2 = load_unaligned<kWidth>(from + 2 * stride);
    const Row p3 = load_unaligned<kWidth>(from + 3 * stride);
    for (std::size_t i = 0; i < 4; ++i) {
        const double(&w)[4] = part.weights[i];
        HWY_ALIGN double out[kWidth];
        store_lanes((Row(w[0]) * p0 + Row(w[1]) * p1) + (Row(w[2]) * p2 + Row(w[3]) * p3), out);
        for (std::size_t k = 0; k < kWidth; ++k) to[i * stride + k] = out[k];
    }
}

void cubic_part(const PlaneNet& whole, const PatchCell& cell, PlaneNet& part) {
    part.degree_u = part.degree_v = 3;
    const CubicPart along_u(cell.u0, cell.u1), along_v(cell.v0, cell.v1);
    HWY_ALIGN double rows[32];
    part_of_four<8>(along_u, &whole.at[0].x, 8, rows);
    for (std::size_t i = 0; i < 4; ++i) {
        part_of_four<2>(along_v, rows + 8 * i, 2, &part.at[4 * i].x);
    }
}
