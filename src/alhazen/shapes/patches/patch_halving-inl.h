/// Bounds and halves of bicubic cells in the plane of a line; a fragment without a guard, included
/// by patch_lanes.cpp in the namespace of each instruction set.
///
/// Conventions: `Point` has four lanes, doubles.

HWY_INLINE double largest(const Point& a) {
    HWY_ALIGN double x[4];
    store_lanes(a, x);
    const double p = x[0] > x[1] ? x[0] : x[1], q = x[2] > x[3] ? x[2] : x[3];
    return p > q ? p : q;
}
HWY_INLINE double weighted_sum(const Point& a, double c0, double c1, double c2, double c3) {
    HWY_ALIGN double x[4];
    store_lanes(a, x);
    return c0 * x[0] + c1 * x[1] + c2 * x[2] + c3 * x[3];
}

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

HWY_INLINE void extremes(const Point (&x)[4], double& least, double& most) {
    most = largest(max_lanes(max_lanes(x[0], x[1]), max_lanes(x[2], x[3])));
    least = -largest(-min_lanes(min_lanes(x[0], x[1]), min_lanes(x[2], x[3])));
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

HWY_INLINE void middle_of(const CubicRows& rows, double& f, double& f_u, double& f_v) {
    const Point one(0.125), three(0.375), slope(0.375);
    const Point at =
        (one * rows.row[0] + three * rows.row[1]) + (three * rows.row[2] + one * rows.row[3]);
    const Point rise = slope * ((rows.row[3] - rows.row[0]) + (rows.row[2] - rows.row[1]));
    f = weighted_sum(at, 0.125, 0.375, 0.375, 0.125);
    f_u = weighted_sum(rise, 0.125, 0.375, 0.375, 0.125);
    f_v = weighted_sum(at, -0.375, -0.375, 0.375, 0.375);
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
    middle_of(x, out.f.x, out.f_u.x, out.f_v.x);
    middle_of(y, out.f.y, out.f_u.y, out.f_v.y);
    const auto size_of = [](const PlanePoint& p) {
        return (p.x < 0 ? -p.x : p.x) + (p.y < 0 ? -p.y : p.y);
    };
    const PlanePoint along = size_of(out.f_u) > size_of(out.f_v) ? out.f_u : out.f_v;
    const double scale = size_of(along);
    const Point ax(scale > 0.0 ? -along.y / scale : 0.5), ay(scale > 0.0 ? along.x / scale : 0.5);
    extremes(x.row, out.least[0], out.most[0]);
    extremes(y.row, out.least[1], out.most[1]);
    Point aside[4];
    for (std::size_t i = 0; i < 4; ++i) aside[i] = x.row[i] * ax + y.row[i] * ay;
    extremes(aside, out.least[2], out.most[2]);
    for (int axis = 0; axis < 3; ++axis) {
        if (out.least[axis] > margin || out.most[axis] < -margin) return;
    }
    const double det = out.f_u.x * out.f_v.y - out.f_u.y * out.f_v.x;
    const double inverse = det != 0.0 ? 1.0 / det : 0.0;
    HWY_ALIGN static constexpr double kKeep[3][4] = {{1, 1, 1, 1}, {1, 1, 1, 0}, {1, 1, 0, 0}};
    Largest uu, uv, vv;
    for (Largest* most : {&uu, &uv, &vv}) {
        most->ux = Point(inverse * out.f_v.y);
        most->uy = Point(-inverse * out.f_v.x);
        most->vx = Point(-inverse * out.f_u.y);
        most->vy = Point(inverse * out.f_u.x);
    }
    uu.keep = load_lanes<4>(kKeep[0]);
    uv.keep = load_lanes<4>(kKeep[1]);
    vv.keep = load_lanes<4>(kKeep[2]);
    Point extent_u(0.0), extent_v(0.0);
    const Point two(2.0);
    for (std::size_t i = 0; i < 4; ++i) {
        const Point vx = x.by_one[i] - x.row[i], vy = y.by_one[i] - y.row[i];
        extent_v = max_lanes(extent_v, uv.keep * (abs(vx) + abs(vy)));
        vv.include(x.by_two[i] - two * x.by_one[i] + x.row[i],
                   y.by_two[i] - two * y.by_one[i] + y.row[i]);
        if (i < 3) {
            const Point ux = x.row[i + 1] - x.row[i], uy = y.row[i + 1] - y.row[i];
            extent_u = max_lanes(extent_u, abs(ux) + abs(uy));
            uv.include((x.by_one[i + 1] - x.by_one[i]) - ux, (y.by_one[i + 1] - y.by_one[i]) - uy);
        }
        if (i < 2) {
            uu.include(x.row[i + 2] - two * x.row[i + 1] + x.row[i],
                       y.row[i + 2] - two * y.row[i + 1] + y.row[i]);
        }
    }
    out.extent_u = largest(extent_u);
    out.extent_v = largest(extent_v);
    const Largest* all[3] = {&uu, &uv, &vv};
    double* sizes[3] = {&out.size_uu, &out.size_uv, &out.size_vv};
    for (int k = 0; k < 3; ++k) {
        *sizes[k] = largest(all[k]->size);
        out.bend_u[k] = largest(all[k]->u);
        out.bend_v[k] = largest(all[k]->v);
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
