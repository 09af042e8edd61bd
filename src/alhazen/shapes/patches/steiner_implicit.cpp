#include "alhazen/shapes/patches/steiner_implicit.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/bernstein_roots.h"
#include "alhazen/math/real128.h"
#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

namespace {

// ---- linear algebra in 113 bits

using WideRow = std::vector<Real128>;

Real128 wide_product(const WideRow& a, const WideRow& b) {
    Real128 sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
}

/// Makes `v` orthogonal to orthonormal vectors, twice because of rounding; returns its remaining
/// length.
Real128 make_orthogonal(WideRow& v, const std::vector<WideRow>& to) {
    for (int pass = 0; pass < 2; ++pass) {
        for (const WideRow& e : to) {
            const Real128 part = wide_product(v, e);
            for (std::size_t k = 0; k < v.size(); ++k) v[k] -= part * e[k];
        }
    }
    return square_root(wide_product(v, v));
}

void append_orthonormal(std::vector<WideRow>& basis, WideRow v) {
    const Real128 size = make_orthogonal(v, basis);
    for (Real128& x : v) x /= size;
    basis.push_back(std::move(v));
}

Real128 wide_magnitude(Real128 x) {
    return x < 0 ? -x : x;
}

/// Thresholds relative to the largest pivot: below the first a pivot is 0, above the second it is
/// not. In between the rank is uncertain.
constexpr double kZeroPivot = 1e-13, kSurePivot = 1e-8;

/// An orthonormal basis of the kernel of the rows, by elimination with full pivoting. Empty if the
/// rank is uncertain.
std::vector<WideRow> kernel_of(std::vector<WideRow> a) {
    const std::size_t rows = a.size(), columns = a[0].size();
    std::vector<std::size_t> order(columns);
    for (std::size_t k = 0; k < columns; ++k) order[k] = k;
    std::size_t rank = 0;
    Real128 largest = 0;
    for (; rank < rows; ++rank) {
        std::size_t row = rank, column = rank;
        for (std::size_t i = rank; i < rows; ++i) {
            for (std::size_t j = rank; j < columns; ++j) {
                if (wide_magnitude(a[i][order[j]]) > wide_magnitude(a[row][order[column]])) {
                    row = i;
                    column = j;
                }
            }
        }
        const Real128 pivot = wide_magnitude(a[row][order[column]]);
        largest = std::max(largest, pivot);
        if (!(pivot > kZeroPivot * largest)) break;
        if (!(pivot > kSurePivot * largest)) return {};
        std::swap(a[row], a[rank]);
        std::swap(order[column], order[rank]);
        for (std::size_t i = 0; i < rows; ++i) {
            if (i == rank) continue;
            const Real128 factor = a[i][order[rank]] / a[rank][order[rank]];
            if (factor == 0) continue;
            for (std::size_t j = rank; j < columns; ++j) {
                a[i][order[j]] -= factor * a[rank][order[j]];
            }
        }
    }
    std::vector<WideRow> basis;
    for (std::size_t j = rank; j < columns; ++j) {
        WideRow v(columns, 0);
        v[order[j]] = 1;
        for (std::size_t i = 0; i < rank; ++i) v[order[i]] = -a[i][order[j]] / a[i][order[i]];
        append_orthonormal(basis, std::move(v));
    }
    return basis;
}

// ---- homogeneous polynomials in (r, u, v)

/// Index of the coefficient of u^i v^j r^(n - i - j) in a polynomial of degree n.
std::size_t triangle_index(int i, int j) {
    return static_cast<std::size_t>((i + j) * (i + j + 1) / 2 + j);
}
std::size_t triangle_size(int degree) {
    return static_cast<std::size_t>((degree + 1) * (degree + 2) / 2);
}
/// The product of polynomials of degrees n and m.
WideRow wide_multiplied(const WideRow& a, int n, const WideRow& b, int m) {
    WideRow result(triangle_size(n + m), 0);
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; i + j <= n; ++j) {
            for (int k = 0; k <= m; ++k) {
                for (int l = 0; k + l <= m; ++l) {
                    result[triangle_index(i + k, j + l)] +=
                        a[triangle_index(i, j)] * b[triangle_index(k, l)];
                }
            }
        }
    }
    return result;
}
/// The parameter r, u or v as a polynomial.
WideRow wide_parameter(std::size_t k) {
    WideRow result(3, 0);
    result[k] = 1;
    return result;
}

/// The coordinates x, y, z and w of the patch as polynomials of degree 2.
std::array<WideRow, 4> coordinates_of(const std::array<HomogeneousPoint, 6>& p) {
    const auto row = [&](auto part) {
        WideRow c(6, 0);
        c[triangle_index(0, 0)] = part(p[0]);
        c[triangle_index(1, 0)] = 2 * Real128(part(p[1]));
        c[triangle_index(2, 0)] = part(p[2]);
        c[triangle_index(0, 1)] = 2 * Real128(part(p[3]));
        c[triangle_index(1, 1)] = 2 * Real128(part(p[4]));
        c[triangle_index(0, 2)] = part(p[5]);
        return c;
    };
    return {row([](const HomogeneousPoint& q) { return q.x; }),
            row([](const HomogeneousPoint& q) { return q.y; }),
            row([](const HomogeneousPoint& q) { return q.z; }),
            row([](const HomogeneousPoint& q) { return q.w; })};
}

/// The kernel of the map from coefficients to the polynomial: one column for each.
std::vector<WideRow> kernel_of_columns(const std::vector<WideRow>& columns) {
    std::vector<WideRow> rows(columns[0].size(), WideRow(columns.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t j = 0; j < columns.size(); ++j) rows[i][j] = columns[j][i];
    }
    return kernel_of(std::move(rows));
}

/// Index of the product of coordinates i <= j among the ten.
std::size_t pair_index(std::size_t i, std::size_t j) {
    if (i > j) std::swap(i, j);
    return i * (9 - i) / 2 + j - i;
}

// ---- polynomials along a line

using AlongLine = std::array<double, 5>;  ///< coefficients of ascending powers

/// Largest distance of a root on the patch from the ray, relative to the patch's size.
constexpr double kMostOff = 1e-8;
/// Half of the interval searched: the patch lies in the cube from -1 to 1.
constexpr double kReachAlong = 1.75;

/// f on [-h, h] in Bernstein form.
BernsteinPolynomial<double, 4> bernstein_form(const AlongLine& f, double h, int degree) {
    BernsteinPolynomial<double, 4> p;
    p.degree = degree;
    p.b.fill(0.0);
    // t = h (2 s - 1): t^k = h^k (s - (1 - s))^k, raised to the degree.
    double largest = 0.0, power = 1.0;
    for (int k = 0; k <= degree; ++k, power *= h) {
        for (int i = 0; i <= degree; ++i) {
            double sum = 0.0;
            for (int j = std::max(0, i - (degree - k)); j <= std::min(i, k); ++j) {
                const auto& binomial = bernstein::kBinomials<4>;
                const auto at = [](int x) { return static_cast<std::size_t>(x); };
                const double term = binomial[at(k)][at(j)] * binomial[at(degree - k)][at(i - j)] /
                                    binomial[at(degree)][at(i)];
                sum += (k - j) % 2 == 0 ? term : -term;
            }
            p.b[static_cast<std::size_t>(i)] += f[static_cast<std::size_t>(k)] * power * sum;
        }
        largest += std::abs(f[static_cast<std::size_t>(k)]) * power;
    }
    p.error = 0x1p-48 * largest;
    return p;
}

/// The sign changes of f on [-h, h]; returns their number.
int sign_changes(const AlongLine& f, double h, int degree, double* roots) {
    const BernsteinPolynomial<double, 4> p = bernstein_form(f, h, degree);
    SignChanges<4> changes;
    if (!find_sign_changes(p, changes)) {
        BernsteinPolynomial<DoubleDouble, 4> precise;
        precise.degree = degree;
        precise.error = 0.0;
        for (std::size_t k = 0; k < p.b.size(); ++k) precise.b[k] = p.b[k];
        find_sign_changes(precise, changes);
    }
    for (int k = 0; k < changes.count; ++k) {
        roots[k] = h * (2.0 * changes.u[static_cast<std::size_t>(k)] - 1.0);
    }
    return changes.count;
}

}  // namespace

/// The ray in the frame of the patch, from the point nearest to its centre, with unit direction.
struct SteinerImplicit::Line {
    Vec3 origin, direction;
    double shift, per_length;  ///< t = shift + along * per_length
};

SteinerImplicit::SteinerImplicit(const SteinerPatch& patch) : points_(patch.control_points()) {
    Box3 box;
    double heaviest = 0.0;
    for (const Vec3& p : patch.points) box.include(p);
    for (const HomogeneousPoint& p : points_) heaviest = std::max(heaviest, p.w);
    center_ = 0.5 * (box.lo + box.hi);
    const double half = 0.5 * max_component(box.size());
    if (!(half > 0.0)) return;
    scale_ = 1.0 / half;
    for (std::size_t k = 0; k < 6; ++k) {
        points_[k] = homogeneous(scale_ * (patch.points[k] - center_), points_[k].w / heaviest);
    }
    make_planes();
    if (degree_ == 4) make_quadric();
}

void SteinerImplicit::make_planes() {
    const std::array<WideRow, 4> x = coordinates_of(points_);
    std::vector<WideRow> columns;
    for (std::size_t i = 0; i < 3; ++i) {
        for (const WideRow& coordinate : x) {
            columns.push_back(wide_multiplied(wide_parameter(i), 1, coordinate, 2));
        }
    }
    const std::vector<WideRow> kernel = kernel_of_columns(columns);
    if (kernel.size() != 2 && kernel.size() != 3) return;
    degree_ = kernel.size() == 2 ? 4 : 3;
    for (std::size_t k = 0; k < kernel.size(); ++k) {
        for (std::size_t i = 0; i < 12; ++i) {
            planes_[k][i / 4][i % 4] = static_cast<double>(kernel[k][i]);
        }
    }
}

void SteinerImplicit::make_quadric() {
    const std::array<WideRow, 4> x = coordinates_of(points_);
    std::vector<WideRow> columns;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t k = j; k < 4; ++k) {
                columns.push_back(
                    wide_multiplied(wide_parameter(i), 1, wide_multiplied(x[j], 2, x[k], 2), 4));
            }
        }
    }
    const std::vector<WideRow> kernel = kernel_of_columns(columns);
    // Eight of them are the moving planes times a coordinate.
    degree_ = 0;
    if (kernel.size() != 9) return;
    std::vector<WideRow> known;
    for (int plane = 0; plane < 2; ++plane) {
        for (std::size_t j = 0; j < 4; ++j) {
            WideRow v(30, 0);
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t k = 0; k < 4; ++k) {
                    v[10 * i + pair_index(j, k)] += planes_[static_cast<std::size_t>(plane)][i][k];
                }
            }
            append_orthonormal(known, std::move(v));
        }
    }
    WideRow best;
    Real128 longest = 0;
    for (WideRow v : kernel) {
        const Real128 left = make_orthogonal(v, known);
        if (!(left > longest)) continue;
        longest = left;
        best = std::move(v);
    }
    if (!(longest > 0.1)) return;
    degree_ = 4;
    for (std::size_t k = 0; k < 30; ++k) {
        quadric_[k / 10][k % 10] = static_cast<double>(best[k] / longest);
    }
}

namespace {

double plane_at(const std::array<double, 4>& c, const Vec3& p, double w) {
    return c[0] * p.x + c[1] * p.y + c[2] * p.z + c[3] * w;
}
/// The symmetric form of a quadric at two homogeneous points, times 2.
double quadric_at(const std::array<double, 10>& c, const Vec3& p, double w, const Vec3& q,
                  double x) {
    return 2.0 * (c[0] * p.x * q.x + c[4] * p.y * q.y + c[7] * p.z * q.z + c[9] * w * x) +
           c[1] * (p.x * q.y + p.y * q.x) + c[2] * (p.x * q.z + p.z * q.x) +
           c[3] * (p.x * x + w * q.x) + c[5] * (p.y * q.z + p.z * q.y) +
           c[6] * (p.y * x + w * q.y) + c[8] * (p.z * x + w * q.z);
}

}  // namespace

double SteinerImplicit::value(const Vec3& point) const {
    const Vec3 p = scale_ * (point - center_);
    Vec3 rows[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const int k = static_cast<int>(i);
        rows[0][k] = plane_at(planes_[0][i], p, 1.0);
        rows[1][k] = plane_at(planes_[1][i], p, 1.0);
        rows[2][k] = degree_ == 3 ? plane_at(planes_[2][i], p, 1.0)
                                  : 0.5 * quadric_at(quadric_[i], p, 1.0, p, 1.0);
    }
    return dot(rows[2], cross(rows[0], rows[1]));
}

void SteinerImplicit::polynomial(const Line& line, std::array<double, 5>& f) const {
    Vec3 first[3], slope[3], square;
    for (std::size_t i = 0; i < 3; ++i) {
        const int k = static_cast<int>(i);
        for (std::size_t j = 0; j < 3; ++j) {
            first[j][k] = plane_at(planes_[j][i], line.origin, 1.0);
            slope[j][k] = plane_at(planes_[j][i], line.direction, 0.0);
        }
        if (degree_ == 3) continue;
        const std::array<double, 10>& c = quadric_[i];
        first[2][k] = 0.5 * quadric_at(c, line.origin, 1.0, line.origin, 1.0);
        slope[2][k] = quadric_at(c, line.origin, 1.0, line.direction, 0.0);
        square[k] = 0.5 * quadric_at(c, line.direction, 0.0, line.direction, 0.0);
    }
    const Vec3 c0 = accurate_cross(first[0], first[1]);
    const Vec3 c1 = accurate_cross(first[0], slope[1]) + accurate_cross(slope[0], first[1]);
    const Vec3 c2 = accurate_cross(slope[0], slope[1]);
    f = {dot(c0, first[2]), dot(c0, slope[2]) + dot(c1, first[2]),
         dot(c0, square) + dot(c1, slope[2]) + dot(c2, first[2]),
         dot(c1, square) + dot(c2, slope[2]), dot(c2, square)};
}

/// The parameters (r, u, v) span the kernel of the matrix: the cross product of those two rows that
/// differ most.
bool SteinerImplicit::invert(const Vec3& p, double& u, double& v) const {
    Vec3 rows[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const int k = static_cast<int>(i);
        rows[0][k] = plane_at(planes_[0][i], p, 1.0);
        rows[1][k] = plane_at(planes_[1][i], p, 1.0);
        rows[2][k] = degree_ == 3 ? plane_at(planes_[2][i], p, 1.0)
                                  : 0.5 * quadric_at(quadric_[i], p, 1.0, p, 1.0);
    }
    Vec3 best;
    for (int k = 0; k < 3; ++k) {
        const Vec3 c = accurate_cross(rows[k], rows[(k + 1) % 3]);
        if (dot(c, c) > dot(best, best)) best = c;
    }
    const double sum = best.x + best.y + best.z;
    u = best.y / sum;
    v = best.z / sum;
    return std::isfinite(u) && std::isfinite(v);
}

bool SteinerImplicit::polish(const Line& line, double& u, double& v, double& along) const {
    Vec3 e, g;
    const Vec3 a = abs(line.direction);
    const Vec3 axis =
        a.x < a.y && a.x < a.z ? Vec3{1, 0, 0} : (a.y < a.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
    e = normalize(cross(line.direction, axis));
    g = cross(line.direction, e);
    const double e0 = dot(e, line.origin), g0 = dot(g, line.origin);
    const auto part = [](const Vec3& axis_, double at, const HomogeneousPoint& p) {
        return axis_.x * p.x + axis_.y * p.y + axis_.z * p.z - at * p.w;
    };
    for (int step = 0; step < 6; ++step) {
        const SteinerValue s = steiner_value(points_, u, v);
        const double fx = part(e, e0, s.s), fy = part(g, g0, s.s);
        const double ux = part(e, e0, s.s_u), uy = part(g, g0, s.s_u);
        const double vx = part(e, e0, s.s_v), vy = part(g, g0, s.s_v);
        const double area = difference_of_products(ux, vy, uy, vx);
        const double du = -difference_of_products(fx, vy, fy, vx) / area;
        const double dv = -difference_of_products(ux, fy, uy, fx) / area;
        if (!(std::abs(du) + std::abs(dv) < 0.5)) break;
        u += du;
        v += dv;
        if (std::abs(du) + std::abs(dv) < 1e-15) break;
    }
    const SteinerValue s = steiner_value(points_, u, v);
    if (!(s.s.w > 0.0)) return false;
    const Vec3 p = projected(s.s) - line.origin;
    along = dot(p, line.direction);
    return length(p - along * line.direction) < kMostOff;
}

int SteinerImplicit::crossings(const Ray& ray, ShapeHit* hits) const {
    const double per_length = 1.0 / length(ray.direction);
    Line line;
    line.direction = per_length * ray.direction;
    const double nearest = dot(center_ - ray.origin, line.direction);
    line.origin = scale_ * ((ray.origin - center_) + nearest * line.direction);
    line.shift = nearest * per_length;
    line.per_length = per_length / scale_;
    AlongLine f;
    polynomial(line, f);
    double roots[4];
    const int found = sign_changes(f, kReachAlong, degree_, roots);
    int count = 0;
    for (int k = 0; k < found; ++k) {
        double u, v, along = roots[k];
        if (!invert(line.origin + along * line.direction, u, v)) continue;
        // Refinement changes only the last digits.
        if (u < -0.01 || v < -0.01 || u + v > 1.01 || !polish(line, u, v, along)) continue;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        count +=
            report_crossing(ray, {line.shift + along * line.per_length, u, v, 0}, hits + count);
    }
    std::sort(hits, hits + count, [](const ShapeHit& a, const ShapeHit& b) { return a.t < b.t; });
    return count;
}

}  // namespace alhazen
