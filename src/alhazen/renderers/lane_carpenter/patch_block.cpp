#include "alhazen/renderers/lane_carpenter/patch_block.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/renderers/lane_carpenter/patch_block.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

/// Four lanes are one register of AVX.
constexpr std::size_t kFour = 4;
using Four = Lanes<double, kFour>;
using FourMask = LaneMask<double, kFour>;

struct FourVec {
    Four x, y, z;
};
HWY_INLINE FourVec operator+(const FourVec& a, const FourVec& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE FourVec operator-(const FourVec& a, const FourVec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE FourVec operator*(const Four& s, const FourVec& a) {
    return {s * a.x, s * a.y, s * a.z};
}
HWY_INLINE Four dot(const FourVec& a, const FourVec& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE FourVec cross(const FourVec& a, const FourVec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE FourVec select(const FourMask& mask, const FourVec& yes, const FourVec& no) {
    return {select_lanes(mask, yes.x, no.x), select_lanes(mask, yes.y, no.y),
            select_lanes(mask, yes.z, no.z)};
}
HWY_INLINE FourVec load_vector(const double (&lanes)[3][PatchBlock::kMost], std::size_t first) {
    return {load_lanes<kFour>(lanes[0] + first), load_lanes<kFour>(lanes[1] + first),
            load_lanes<kFour>(lanes[2] + first)};
}
HWY_INLINE void store_vector(const FourVec& a, double (&lanes)[3][PatchBlock::kMost],
                             std::size_t first) {
    store_lanes(a.x, lanes[0] + first);
    store_lanes(a.y, lanes[1] + first);
    store_lanes(a.z, lanes[2] + first);
}

/// The Bernstein polynomials of a degree, and their derivatives: as in patch_surface.cpp.
struct FourBernstein {
    Four value[kMaxPatchOrder], slope[kMaxPatchOrder];

    HWY_INLINE FourBernstein(int degree, const Four& x) {
        const Four y = Four(1.0) - x;
        if (degree == 3) {
            const Four xx = x * x, yy = y * y, xy = Four(2.0) * x * y, three(3.0);
            value[0] = yy * y;
            value[1] = three * yy * x;
            value[2] = three * y * xx;
            value[3] = xx * x;
            slope[0] = Four(-3.0) * yy;
            slope[1] = three * (yy - xy);
            slope[2] = three * (xy - xx);
            slope[3] = three * xx;
            return;
        }
        value[0] = Four(1.0);
        for (int n = 1; n <= degree; ++n) {
            if (n == degree) set_slope(degree);
            Four carry(0.0);
            for (int k = 0; k < n; ++k) {
                const Four old = value[k];
                value[k] = carry + y * old;
                carry = x * old;
            }
            value[n] = carry;
        }
    }

  private:
    HWY_INLINE void set_slope(int degree) {
        const Four n(static_cast<double>(degree));
        slope[0] = -n * value[0];
        for (int k = 1; k < degree; ++k) slope[k] = n * (value[k - 1] - value[k]);
        slope[degree] = n * value[degree - 1];
    }
};

struct FourTangents {
    FourVec point, du, dv;
};

/// `rows`, `columns`: degree + 1; constants for the usual degrees.
template <class Count>
HWY_INLINE FourTangents polynomial_four(const HomogeneousPoint* p, Count rows, Count columns,
                                        const Four& u, const Four& v) {
    const FourBernstein bu(static_cast<int>(rows) - 1, u), bv(static_cast<int>(columns) - 1, v);
    const Four zero(0.0);
    FourTangents s{{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}};
    for (std::size_t i = 0; i < rows; ++i) {
        FourVec value{zero, zero, zero}, slope{zero, zero, zero};
        for (std::size_t j = 0; j < columns; ++j, ++p) {
            const FourVec at{Four(p->x), Four(p->y), Four(p->z)};
            value = value + bv.value[j] * at;
            slope = slope + bv.slope[j] * at;
        }
        s.point = s.point + bu.value[i] * value;
        s.du = s.du + bu.slope[i] * value;
        s.dv = s.dv + bu.value[i] * slope;
    }
    return s;
}

struct FourHomogeneous {
    FourVec at;
    Four w;
};
HWY_INLINE void add(const Four& factor, const FourHomogeneous& p, FourHomogeneous& sum) {
    sum.at = sum.at + factor * p.at;
    sum.w = sum.w + factor * p.w;
}

template <class Count>
HWY_INLINE FourTangents rational_four(const HomogeneousPoint* p, Count rows, Count columns,
                                      const Four& u, const Four& v) {
    const FourBernstein bu(static_cast<int>(rows) - 1, u), bv(static_cast<int>(columns) - 1, v);
    const Four zero(0.0);
    const FourHomogeneous none{{zero, zero, zero}, zero};
    FourHomogeneous s = none, s_u = none, s_v = none;
    for (std::size_t i = 0; i < rows; ++i) {
        FourHomogeneous value = none, slope = none;
        for (std::size_t j = 0; j < columns; ++j, ++p) {
            const FourHomogeneous at{{Four(p->x), Four(p->y), Four(p->z)}, Four(p->w)};
            add(bv.value[j], at, value);
            add(bv.slope[j], at, slope);
        }
        add(bu.value[i], value, s);
        add(bu.slope[i], value, s_u);
        add(bu.value[i], slope, s_v);
    }
    const Four share = Four(1.0) / s.w;
    const FourVec point{s.at.x * share, s.at.y * share, s.at.z * share};
    return {point, share * (s_u.at - s_u.w * point), share * (s_v.at - s_v.w * point)};
}

/// The number of control points in a row of a patch of this degree.
template <int kDegree>
using RowCount = std::integral_constant<std::size_t, std::size_t{kDegree} + 1>;

HWY_INLINE FourTangents tangents_four(const BezierNet& net, bool polynomial, const Four& u,
                                      const Four& v) {
    const HomogeneousPoint* const p = net.points.data();
    const auto rows = static_cast<std::size_t>(net.degree_u) + 1;
    const auto columns = static_cast<std::size_t>(net.degree_v) + 1;
    if (!polynomial) return rational_four(p, rows, columns, u, v);
    if (rows == 4 && columns == 4) {
        return polynomial_four(p, RowCount<3>(), RowCount<3>(), u, v);
    }
    return polynomial_four(p, rows, columns, u, v);
}

/// Within [0, 1].
HWY_INLINE Four limited(const Four& x) {
    const Four zero(0.0), one(1.0);
    return select_lanes(x < zero, zero, select_lanes(x > one, one, x));
}

/// The tangents with the normal that they span.
struct FourPlane {
    FourTangents at;
    FourVec normal;
    Four squared;
    FourMask regular;

    HWY_INLINE explicit FourPlane(const FourTangents& tangents) : at(tangents) {
        normal = cross(at.du, at.dv);
        squared = dot(normal, normal);
        regular =
            (squared > Four(1e-16) * dot(at.du, at.du) * dot(at.dv, at.dv)) & (squared > Four(0.0));
    }
};

HWY_INLINE FourPlane select(const FourMask& mask, const FourPlane& yes, const FourPlane& no) {
    FourPlane result = no;
    result.at.point = select(mask, yes.at.point, no.at.point);
    result.at.du = select(mask, yes.at.du, no.at.du);
    result.at.dv = select(mask, yes.at.dv, no.at.dv);
    result.normal = select(mask, yes.normal, no.normal);
    result.squared = select_lanes(mask, yes.squared, no.squared);
    result.regular = (mask & yes.regular) | ((!mask) & no.regular);
    return result;
}

/// The result of a step of Newton's method: the point, u and v.
struct FourSolution {
    FourVec point;
    Four u, v;
};

/// A step in the lanes of `active`. Returns the lanes whose step was longer than the error.
HWY_INLINE FourMask step_four(const FourPlane& plane, const FourVec& origin,
                              const FourVec& direction, const Four& error, const FourMask& active,
                              FourSolution& solution) {
    const Four quarter(0.25);
    const Four facing = dot(direction, plane.normal);
    const Four t = dot(plane.at.point - origin, plane.normal) / facing;
    const FourVec met = origin + t * direction;
    const FourVec offset = met - plane.at.point;
    const Four share = Four(1.0) / plane.squared;
    const Four du = dot(cross(offset, plane.at.dv), plane.normal) * share;
    const Four dv = dot(cross(plane.at.du, offset), plane.normal) * share;
    const FourMask found = active & (t > Four(0.0)) & (abs(du) < quarter) & (abs(dv) < quarter) &
                           (facing * facing > Four(1e-4) * plane.squared);
    solution.point = select(found, met, solution.point);
    solution.u = select_lanes(found, limited(solution.u + du), solution.u);
    solution.v = select_lanes(found, limited(solution.v + dv), solution.v);
    return found & (!(dot(offset, offset) <= Four(kShortStep * kShortStep) * error * error));
}

HWY_INLINE std::uint32_t find_four(const BezierNet& net, bool polynomial, std::size_t first,
                                   PatchBlock& block) {
    HWY_ALIGN double origins[3][PatchBlock::kMost], directions[3][PatchBlock::kMost];
    for (std::size_t k = 0; k < kFour; ++k) {
        const Ray& ray = block.rays[first + k < block.count ? first + k : block.count - 1];
        origins[0][k] = ray.origin.x;
        origins[1][k] = ray.origin.y;
        origins[2][k] = ray.origin.z;
        directions[0][k] = ray.direction.x;
        directions[1][k] = ray.direction.y;
        directions[2][k] = ray.direction.z;
    }
    const FourVec origin = load_vector(origins, 0), direction = load_vector(directions, 0);
    const Four error = load_lanes<kFour>(block.error + first);
    FourSolution solution;
    solution.u = load_lanes<kFour>(block.u + first);
    solution.v = load_lanes<kFour>(block.v + first);
    FourPlane plane(tangents_four(net, polynomial, solution.u, solution.v));
    solution.point = plane.at.point;
    const std::size_t count = block.count - first;
    FourMask active = plane.regular;
    if (count < kFour) active = active & lanes_of_bits<double, kFour>((1u << count) - 1u);
    for (int round = 0; round < 2; ++round) {
        active = step_four(plane, origin, direction, error, active, solution);
        if (bits_of(active) == 0) break;
        const FourPlane next(tangents_four(net, polynomial, solution.u, solution.v));
        plane = select(active, next, plane);
        active = active & plane.regular;
    }
    const Four length = sqrt(plane.squared);
    const FourVec unit{plane.normal.x / length, plane.normal.y / length, plane.normal.z / length};
    store_vector(solution.point, block.point, first);
    store_vector(unit, block.normal, first);
    store_vector(plane.at.du, block.du, first);
    store_vector(plane.at.dv, block.dv, first);
    store_lanes(solution.u, block.u + first);
    store_lanes(solution.v, block.v + first);
    return bits_of(plane.regular) << first;
}

}  // namespace

void find_patch_points_of_target(const BezierNet& net, bool polynomial, PatchBlock& block) {
    block.regular = find_four(net, polynomial, 0, block);
    if (block.count > kFour) block.regular |= find_four(net, polynomial, kFour, block);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(find_patch_points_of_target);

void find_patch_points(const BezierNet& net, bool polynomial, PatchBlock& block) {
    ALHAZEN_KERNEL(find_patch_points_of_target)(net, polynomial, block);
}

}  // namespace alhazen
#endif
