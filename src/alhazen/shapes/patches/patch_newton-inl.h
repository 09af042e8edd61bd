/// Newton's method for bicubic patches in the plane of a line; a fragment without a guard, included
/// by patch_lanes.cpp in the namespace of each instruction set.
///
/// Conventions: `Point` has four lanes, doubles.

/// The control points times their weights along three axes.
void cubic_line(const HomogeneousPoint* points, const PatchLine& line, CubicLine& out) {
    const Vec3 &o = line.origin, &ax = line.axis_x, &ay = line.axis_y, &d = line.direction;
    const Point ox(o.x), oy(o.y), oz(o.z);
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < 4; ++i) {
        Point row[4], by_axis[4];
        ALHAZEN_UNROLL
        for (std::size_t j = 0; j < 4; ++j) row[j] = load_unaligned<4>(&points[4 * i + j].x);
        transpose_lanes(row, by_axis);
        const Point x = by_axis[0] - by_axis[3] * ox, y = by_axis[1] - by_axis[3] * oy;
        const Point z = by_axis[2] - by_axis[3] * oz;
        const auto along = [&](const Vec3& axis) {
            return Point(axis.x) * x + Point(axis.y) * y + Point(axis.z) * z;
        };
        store_lanes(along(ax), out.x + 4 * i);
        store_lanes(along(ay), out.y + 4 * i);
        store_lanes(along(d), out.z + 4 * i);
    }
}

/// Bernstein polynomials of degree 3 and their derivatives in lanes.
struct CubicBasis {
    LaneMask<double, 4> last, last_two, last_three;
    Point value, lower, upper;

    HWY_INLINE CubicBasis() {
        HWY_ALIGN static constexpr double kValue[4] = {1, 3, 3, 1};
        HWY_ALIGN static constexpr double kLower[4] = {0, 3, 6, 3}, kUpper[4] = {3, 6, 3, 0};
        HWY_ALIGN static constexpr double kPlace[4] = {0, 1, 2, 3};
        const Point place = load_lanes<4>(kPlace);
        last = place > Point(2.5);
        last_two = place > Point(1.5);
        last_three = place > Point(0.5);
        value = load_lanes<4>(kValue);
        lower = load_lanes<4>(kLower);
        upper = load_lanes<4>(kUpper);
    }
    HWY_INLINE void at(double parameter, Point& values, Point& slopes) const {
        const Point t(parameter), s(1.0 - parameter);
        const Point a = select_lanes(last, t, s), b = select_lanes(last_two, t, s);
        const Point c = select_lanes(last_three, t, s);
        const Point ab = a * b, bc = b * c;
        values = value * (ab * c);
        slopes = lower * ab - upper * bc;
    }
};

/// One weight for each row, in all lanes.
struct RowWeights {
    Point w[4];

    HWY_INLINE explicit RowWeights(const Point& weights)
        : w{Point(0.0), Point(0.0), Point(0.0), Point(0.0)} {
        HWY_ALIGN double each[4];
        store_lanes(weights, each);
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < 4; ++i) w[i] = Point(each[i]);
    }
    HWY_INLINE Point sum(const double* rows) const {
        return (w[0] * load_lanes<4>(rows) + w[1] * load_lanes<4>(rows + 4)) +
               (w[2] * load_lanes<4>(rows + 8) + w[3] * load_lanes<4>(rows + 12));
    }
};

NewtonEnd cubic_newton(const CubicLine& net, const CubicNewton& task, CubicRoot& out) {
    const auto size_of = [](double x) { return x < 0.0 ? -x : x; };
    const auto larger = [](double a, double b) { return a > b ? a : b; };
    const CubicBasis basis;
    const PatchCell& cell = task.cell;
    const double width_u = cell.u1 - cell.u0, width_v = cell.v1 - cell.v0;
    const double per_u = 1.0 / width_u, per_v = 1.0 / width_v;
    const double margin_u = kCellMargin * width_u, margin_v = kCellMargin * width_v;
    const Point none(0.0);
    double u = task.u, v = task.v;
    // Bound of the distance from the estimate to the root, if there is one, in widths.
    double reach = 0.25 * kCertified + kCellMargin, last = 1.0;
    bool ranged = task.has_range;
    for (int step = 0; step < 40; ++step) {
        const double far_u = reach * width_u, far_v = reach * width_v;
        if (!(u >= cell.u0 - far_u && u <= cell.u1 + far_u && v >= cell.v0 - far_v &&
              v <= cell.v1 + far_v)) {
            return NewtonEnd::NoRoot;
        }
        const auto clamped = [](double x, double least, double most) {
            return x < least ? least : x > most ? most : x;
        };
        u = clamped(u, cell.u0 - margin_u, cell.u1 + margin_u);
        v = clamped(v, cell.v0 - margin_v, cell.v1 + margin_v);
        Point of_u, slope_u, of_v, slope_v;
        basis.at(u, of_u, slope_u);
        basis.at(v, of_v, slope_v);
        const RowWeights at_u(of_u), by_u(slope_u);
        HWY_ALIGN double sums[4], more[4];
        const Point x = at_u.sum(net.x), y = at_u.sum(net.y);
        const Point x_by_u = by_u.sum(net.x), y_by_u = by_u.sum(net.y);
        store_lanes(sum_of_each(x * of_v, y * of_v, x_by_u * of_v, y_by_u * of_v), sums);
        store_lanes(sum_of_each(x * slope_v, y * slope_v, none, none), more);
        const double x_u = sums[2], y_u = sums[3], x_v = more[0], y_v = more[1];
        const double det = x_u * y_v - x_v * y_u, inverse = 1.0 / det;
        const double du = (x_v * sums[1] - sums[0] * y_v) * inverse;
        const double dv = (sums[0] * y_u - x_u * sums[1]) * inverse;
        u += du;
        v += dv;
        reach = larger(larger(0.7 * reach, kCellMargin), task.noise);
        const double moved = larger(size_of(du) * per_u, size_of(dv) * per_v);
        // Stops, unless the steps still shrink as they do before rounding dominates. Without a
        // proof of convergence, steps that do not shrink are no indication of rounding.
        const bool stalled = task.converges && last < 0x1p-4 && moved > 0.25 * last;
        last = moved;
        const bool done = moved <= 0x1p-23 || stalled;
        if (!done && !ranged) continue;
        const Point z = at_u.sum(net.z), z_by_u = by_u.sum(net.z);
        HWY_ALIGN double along[4];
        store_lanes(sum_of_each(z * of_v, z_by_u * of_v, z * slope_v, none), along);
        out.z = along[0] + du * along[1] + dv * along[2];
        if (done) {
            out.u = u;
            out.v = v;
            out.x_u = x_u;
            out.y_u = y_u;
            out.x_v = x_v;
            out.y_v = y_v;
            return NewtonEnd::Root;
        }
        // The root is at most 8/7 of this step away; within that distance the surface deviates from
        // its tangent plane by less than 3 `bend` moved^2.
        const double bent = 3.0 * task.bend * moved * moved *
                            (size_of(x_u) + size_of(y_u) + size_of(along[1])) *
                            (size_of(x_v) + size_of(y_v) + size_of(along[2]));
        const double size = size_of(det);
        const double beyond = larger(out.z - task.most, task.least - out.z) * size;
        if (beyond > bent) return NewtonEnd::OutOfRange;
        ranged = beyond > -bent;
    }
    return NewtonEnd::NoRoot;
}
