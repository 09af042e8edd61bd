#include "alhazen/shapes/algebraic/algebraic.h"

#include "alhazen/base/error.h"
#include "alhazen/base/instruction_sets.h"
#include "alhazen/shapes/algebraic/polynomial_lanes.h"
#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/core/first_hits.h"
#include "alhazen/shapes/core/plain_surface.h"
#include "alhazen/shapes/quadrics/clipped_quadric.h"

namespace alhazen {

namespace {

/// A polynomial of degree at most N.
template <int N>
struct AlgebraicPolynomial {
    static constexpr int kDegree = N;
    const Algebraic& shape;

    template <class Real>
    int coefficients(const Point3<Real>& p, const Point3<Real>& q, Real* b) const {
        shape.polynomial->restricted(p, q, b);
        return shape.polynomial->degree();
    }
    template <class Real>
    [[nodiscard]] Real value(const Point3<Real>& p) const {
        return shape.polynomial->value(p);
    }
    [[nodiscard]] Vec3 gradient(const Vec3& p) const { return shape.polynomial->gradient(p); }
    [[nodiscard]] double magnitude() const { return shape.magnitude; }
    [[nodiscard]] double roundings() const { return shape.roundings; }
};

constexpr int kMostDegree = PolynomialExpression::kMaxDegree;

template <class F>
auto with_polynomial(const Algebraic& shape, F&& f) {
    switch (shape.polynomial->degree()) {
        case 4:
            return f(AlgebraicPolynomial<4>{shape});
        case 6:
            return f(AlgebraicPolynomial<6>{shape});
        default:
            return f(AlgebraicPolynomial<kMostDegree>{shape});
    }
}

/// Largest absolute coordinates of a box.
Vec3 reach_of(const Box3& box) {
    Vec3 reach;
    for (int k = 0; k < 3; ++k) {
        reach[k] = std::fmax(std::abs(box.lo[k]), std::abs(box.hi[k]));
    }
    return reach;
}

}  // namespace

void Algebraic::prepare() {
    polynomial = std::make_shared<const PolynomialExpression>(expression);
    const Vec3 reach = reach_of(clip_box);
    size = std::fmin(reach.x, std::fmin(reach.y, reach.z));
    magnitude = polynomial->magnitude(reach);
    roundings = polynomial->roundings();
}

void Algebraic::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.point("clip_box", clip_box.lo);
    checks.point("clip_box", clip_box.hi);
    for (int k = 0; k < 3 && checks.ok(); ++k) {
        if (!(clip_box.lo[k] < clip_box.hi[k])) {
            checks.fail("clip_box must be ((x, y, z), (x, y, z)) with the lower corner first");
        }
    }
    try {
        const PolynomialExpression parsed(expression);
        if (parsed.degree() < 1) checks.fail("expression: x, y and z do not occur in it");
        // Larger values overflow when they are squared.
        if (checks.ok() && !(parsed.magnitude(reach_of(clip_box)) < 1e150)) {
            checks.fail(
                "expression: the sum of its terms without signs must be below 1e150 within "
                "clip_box");
        }
    } catch (const Error& error) {
        checks.fail("expression: " + std::string(error.what()));
    }
}

Interval Algebraic::extent(const Vec3& axis) const {
    const Interval range = alhazen::extent(clip_box, axis);
    const double pad = gamma_bound(8) * (std::abs(range.lo) + std::abs(range.hi));
    return {range.lo - pad, range.hi + pad};
}

namespace {

// One instance for all degrees: an instance for each would triple the code, which is compiled
// twice.
int all_hits_body(const Algebraic& shape, const Ray& ray, ShapeHit* hits) {
    ClipSegment s;
    const SolidFrame frame;
    if (!clip_segment(frame, ray, shape.clip_box, shape.size, s)) return 0;
    return intersect_segment(AlgebraicPolynomial<kMostDegree>{shape}, frame, ray, s, shape.capped,
                             hits);
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET(int all_hits(const Algebraic& shape, const Ray& ray,
                                              ShapeHit* hits),
                                 all_hits_body(shape, ray, hits))

bool one_hit_body(const Algebraic& shape, const Ray& ray, ShapeHit& hit) {
    ClipSegment s;
    const SolidFrame frame;
    if (!clip_segment(frame, ray, shape.clip_box, shape.size, s)) return false;
    return with_polynomial(shape, [&](const auto& f) {
        return first_on_segment(f, frame, ray, s, shape.capped, hit);
    });
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET(bool one_hit(const Algebraic& shape, const Ray& ray,
                                              ShapeHit& hit),
                                 one_hit_body(shape, ray, hit))

}  // namespace

int Algebraic::intersect(const Ray& ray, ShapeHit* hits) const {
    return all_hits(*this, ray, hits);
}

bool first_hit(const Algebraic& shape, const Ray& ray, ShapeHit& hit) {
    return one_hit(shape, ray, hit);
}

namespace {

double improved_body(const Algebraic& shape, const Ray& ray, std::size_t lane,
                     const PolynomialLanes& lanes) {
    return with_polynomial(shape, [&](const auto& f) {
        return improved_root_of_lane(f, SolidFrame(), ray, lane, lanes);
    });
}
ALHAZEN_FOR_EACH_INSTRUCTION_SET(double improved(const Algebraic& shape, const Ray& ray,
                                                 std::size_t lane, const PolynomialLanes& lanes),
                                 improved_body(shape, ray, lane, lanes))

}  // namespace

std::uint32_t first_hits(const Algebraic& shape, std::span<const Ray* const> rays, ShapeHit* hits) {
    return first_hits_in_lanes(
        rays, hits,
        [&](const PolynomialKernels& kernels, const RayLanes& in, PolynomialLanes& lanes) {
            kernels.algebraic(shape, in, lanes);
        },
        [&](const Ray& ray, std::size_t lane, const PolynomialLanes& lanes) {
            return improved(shape, ray, lane, lanes);
        },
        [&](const Ray& ray, ShapeHit& hit) { return one_hit(shape, ray, hit); });
}

namespace {

ProjectedPoint point_on(const Algebraic& shape, const Ray& ray, const ShapeHit& hit) {
    const Vec3 d = unit_or(ray.direction, {0, 0, 1});
    return project_to_zero(AlgebraicPolynomial<kMostDegree>{shape}, ray.at(hit.t),
                           (-1e-6 * shape.size) * d);
}

}  // namespace

ShapeSurface plain_surface(const Algebraic& shape, const Ray& ray, const ShapeHit& hit) {
    if (hit.part > 0) return shape.surface(ray, hit);
    return surface_of(SolidFrame(), point_on(shape, ray, hit));
}

ShapeSurface Algebraic::surface(const Ray& ray, const ShapeHit& hit) const {
    const SolidFrame frame;
    if (hit.part > 0) return clip_face_surface(frame, clip_box, {}, ray.at(hit.t), hit.part);
    const ProjectedPoint at = point_on(*this, ray, hit);
    ShapeSurface surface = surface_of(frame, at);
    const Vec3 p = at.point - clip_box.center();
    LocalUv local = turn_uv(p);
    const double across = std::hypot(p.x, p.y);
    const double squared = kPi * length_squared(p);
    local.uv.y = 0.5 + std::atan2(p.z, across) / kPi;
    if (across > 0.0) {
        local.v_gradient = Vec3{-p.z * p.x / across, -p.z * p.y / across, across} / squared;
    }
    set_uv(frame, local, at.gradient, surface, 0.2);
    return surface;
}

}  // namespace alhazen
