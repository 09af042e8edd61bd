#include "alhazen/geometry/polygon_sets/lattice.h"

#include <cmath>

namespace alhazen {

namespace {

/// Bound, with a margin, on the distance of a place's coordinates from their approximations.
constexpr double kPlaceError = 0x1p-20;

std::strong_ordering exact_order(Int128 a, std::int64_t a_den, Int128 b, std::int64_t b_den) {
    const Int128 left = a * b_den;
    const Int128 right = b * a_den;
    if (left == right) {
        return std::strong_ordering::equal;
    }
    return left < right ? std::strong_ordering::less : std::strong_ordering::greater;
}

/// floor(scaled / den + 1/2)
std::int32_t exact_round(Int128 scaled, std::int64_t den) {
    const Int128 n = 2 * scaled + den;
    const Int128 d = Int128{2} * den;
    Int128 q = n / d;
    if (q * d > n) {
        --q;
    }
    return static_cast<std::int32_t>(q);
}

bool near_integer(double v) {
    return std::abs(v - std::nearbyint(v)) < kPlaceError;
}

}  // namespace

LatticePlace crossing(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
    std::int64_t den = cross_of(a, b, c, d);
    std::int64_t num = cross_of(a, c, c, d);
    if (den < 0) {
        den = -den;
        num = -num;
    }
    const double t = static_cast<double>(num) / static_cast<double>(den);
    return {a, b, num, den, a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
}

std::strong_ordering compare(const LatticePlace& a, const LatticePlace& b) {
    if (std::abs(a.x - b.x) > kPlaceError) {
        return a.x < b.x ? std::strong_ordering::less : std::strong_ordering::greater;
    }
    const std::strong_ordering by_x = exact_order(a.scaled_x(), a.den, b.scaled_x(), b.den);
    if (by_x != std::strong_ordering::equal) {
        return by_x;
    }
    if (std::abs(a.y - b.y) > kPlaceError) {
        return a.y < b.y ? std::strong_ordering::less : std::strong_ordering::greater;
    }
    return exact_order(a.scaled_y(), a.den, b.scaled_y(), b.den);
}

int side_of(LatticePoint a, LatticePoint b, const LatticePlace& p) {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double near = dx * (p.y - a.y) - dy * (p.x - a.x);
    // The error is 2^25 (2^-24 + 2^-24) from the coordinates and less than 1 from the arithmetic.
    if (std::abs(near) > 16) {
        return near > 0 ? 1 : -1;
    }
    const Int128 exact = Int128{b.x - a.x} * (p.scaled_y() - Int128{a.y} * p.den) -
                         Int128{b.y - a.y} * (p.scaled_x() - Int128{a.x} * p.den);
    return exact > 0 ? 1 : (exact < 0 ? -1 : 0);
}

LatticePoint rounded(const LatticePlace& p) {
    const double x = p.x + 0.5;
    const double y = p.y + 0.5;
    return {near_integer(x) ? exact_round(p.scaled_x(), p.den)
                            : static_cast<std::int32_t>(std::floor(x)),
            near_integer(y) ? exact_round(p.scaled_y(), p.den)
                            : static_cast<std::int32_t>(std::floor(y))};
}

bool on_lattice(const LatticePlace& p) {
    return near_integer(p.x) && near_integer(p.y) && p.scaled_x() % p.den == 0 &&
           p.scaled_y() % p.den == 0;
}

bool meets_pixel(LatticePoint a, LatticePoint b, LatticePoint center) {
    // In half units from the pixel's centre, where the pixel is [-1, 1) x [-1, 1).
    std::int64_t ax = 2 * (std::int64_t{a.x} - center.x);
    std::int64_t ay = 2 * (std::int64_t{a.y} - center.y);
    std::int64_t bx = 2 * (std::int64_t{b.x} - center.x);
    std::int64_t by = 2 * (std::int64_t{b.y} - center.y);
    if (std::max(ax, bx) < -1 || std::min(ax, bx) >= 1 || std::max(ay, by) < -1 ||
        std::min(ay, by) >= 1) {
        return false;
    }
    if (ax > bx || (ax == bx && ay > by)) {
        std::swap(ax, bx);
        std::swap(ay, by);
    }
    const std::int64_t dx = bx - ax;
    const std::int64_t dy = by - ay;
    // d x (corner - a) = at + dx v - dy u for the corner (u, v).
    const std::int64_t at = dy * ax - dx * ay;
    if (dy >= 0) {  // rising: its extreme corners are the upper left and the lower right, which do
                    // not belong to the half-open pixel
        const std::int64_t upper_left = at + dx + dy;
        const std::int64_t lower_right = at - dx - dy;
        const bool axis = dx == 0 || dy == 0;
        return axis || (upper_left > 0 && lower_right < 0);
    }
    const std::int64_t lower_left = at - dx + dy;
    const std::int64_t upper_right = at + dx - dy;
    return lower_left <= 0 && upper_right > 0;
}

}  // namespace alhazen
