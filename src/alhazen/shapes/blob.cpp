#include "alhazen/shapes/blob.h"

#include <algorithm>

#include "alhazen/base/instruction_sets.h"
#include "alhazen/math/bernstein_roots.h"
#include "alhazen/shapes/plain_surface.h"
#include "alhazen/shapes/shape_numerics.h"

namespace alhazen {

namespace {

template <class Real>
constexpr double kRounding = std::is_same_v<Real, double> ? 0x1p-53 : kDoubleDoubleUlp;

/// Where a quadratic 1 - (distance / radius)^2 of a component holds along the ray.
enum class Region : std::uint8_t { Base, Middle, Top };
/// Where it does, and what it is there in double: peak - bend (t - middle)^2. Without bend that is
/// not known.
struct Bump {
    Interval t;
    double middle = 0, peak = 1, bend = 0;

    [[nodiscard]] bool known() const { return bend > 0.0; }
    [[nodiscard]] double largest(double t0, double t1) const {
        const double off = std::clamp(middle, t0, t1) - middle;
        return peak - bend * off * off;
    }
};
struct Piece {
    std::uint32_t component;
    Region region;
    double in, out;  ///< from the local origin
    Bump bump;
};
struct Event {
    double t;
    std::uint32_t piece;
    bool begins;
};

template <class Real>
struct Vec3Of {
    Real x, y, z;
};
template <class Real>
Vec3Of<Real> cross_of(const Vec3Of<Real>& a, const Vec3Of<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
Real dot_of(const Vec3Of<Real>& a, const Vec3Of<Real>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
double quotient(double a, double b) {
    return a / b;
}
/// The ray from a point near the blob, and the polynomials along it.
struct LocalRay {
    const Blob& blob;
    const Ray& given;
    double shift = 0;
    Vec3 o;
    double far;  ///< size of the numbers that made o

    LocalRay(const Blob& b, const Ray& ray) : blob(b), given(ray), o(ray.origin) {
        const Vec3 from_center = ray.origin - b.bounds.center();
        // Close by, the shift would only round away digits of a small t.
        if (length_squared(from_center) > 4.0 * length_squared(b.bounds.size())) {
            shift = -dot(from_center, ray.direction) / length_squared(ray.direction);
            o = ray.origin + shift * ray.direction;
        }
        far = max_component(abs(ray.origin)) + std::abs(shift) * max_component(abs(ray.direction));
    }

    /// The point at t (from the local origin) relative to `center`.
    template <class Real>
    [[nodiscard]] Vec3Of<Real> from(const Vec3& center, double t) const {
        const auto along = [&](int k) {
            const Real start = Real(given.origin[k]) + Real(shift) * Real(given.direction[k]);
            return (start - Real(center[k])) + Real(t) * Real(given.direction[k]);
        };
        return {along(0), along(1), along(2)};
    }

    /// Adds strength * q^2 of the piece, q its quadratic, in Bernstein form on [t0, t1].
    template <class Real>
    void add(const Piece& piece, double t0, double t1, BernsteinPolynomial<Real, 4>& sum) const {
        const BlobComponent& c = blob.components[piece.component];
        if constexpr (std::is_same_v<Real, double>) {
            if (piece.bump.known()) {
                const Bump& bump = piece.bump;
                const double a = t0 - bump.middle, b = t1 - bump.middle;
                return add_squared(piece, bump.peak - bump.bend * (a * a),
                                   bump.peak - bump.bend * (a * b), bump.peak - bump.bend * (b * b),
                                   sum);
            }
        }
        const Vec3& center = piece.region == Region::Top ? c.top : c.base;
        Vec3Of<Real> a = from<Real>(center, t0), b = from<Real>(center, t1);
        Real scale = Real(c.radius) * Real(c.radius);
        if (piece.region == Region::Middle) {
            const Vec3Of<Real> e{Real(c.top.x) - Real(c.base.x), Real(c.top.y) - Real(c.base.y),
                                 Real(c.top.z) - Real(c.base.z)};
            a = cross_of(a, e);
            b = cross_of(b, e);
            scale = scale * dot_of(e, e);
        }
        // The blossom of the quadratic.
        const Real q0 = Real(1.0) - quotient(dot_of(a, a), scale);
        const Real q1 = Real(1.0) - quotient(dot_of(a, b), scale);
        const Real q2 = Real(1.0) - quotient(dot_of(b, b), scale);
        add_squared(piece, q0, q1, q2, sum);
    }

  private:
    /// The square of a quadratic with these Bernstein coefficients.
    template <class Real>
    void add_squared(const Piece& piece, const Real& q0, const Real& q1, const Real& q2,
                     BernsteinPolynomial<Real, 4>& sum) const {
        const BlobComponent& c = blob.components[piece.component];
        const Real s = c.strength;
        sum.b[0] -= s * (q0 * q0);
        sum.b[1] -= s * (q0 * q1);
        sum.b[2] -= s * quotient(q0 * q2 + Real(2.0) * (q1 * q1), Real(3.0));
        sum.b[3] -= s * (q1 * q2);
        sum.b[4] -= s * (q2 * q2);
        // Rounding of the points over the radius, of the quadratics, of the products.
        const double span = piece.region == Region::Middle ? length(c.top - c.base) : 0.0;
        const double point = 48.0 * (far + blob.reach + max_component(abs(o)) + span) / c.radius;
        sum.error += kRounding<Real> * std::abs(c.strength) * (4.0 * point + 128.0);
    }
};

/// Where the line, given by its least distance (at t = middle) from an axis or a centre and its
/// speed across, is closer than the radius.
Bump within(double middle, double distance, double radius, double speed) {
    if (!(distance < radius)) return {};
    const double room = (radius - distance) * (radius + distance);
    const double half = std::sqrt(room) / speed, squared = radius * radius;
    return {{middle - half, middle + half}, middle, room / squared, speed * speed / squared};
}

Bump within_ball(const LocalRay& ray, const Vec3& center, double radius) {
    const Vec3 f = ray.o - center;
    const Vec3& d = ray.given.direction;
    const double dd = length_squared(d), middle = -dot(f, d) / dd;
    return within(middle, length(f + middle * d), radius, std::sqrt(dd));
}

Bump within_rod(const LocalRay& ray, const BlobComponent& c) {
    const Vec3 axis = unit_or(c.top - c.base, {0, 0, 1});
    const Vec3 f = cross(ray.o - c.base, axis), d = cross(ray.given.direction, axis);
    const double dd = length_squared(d);
    if (dd <= 1e-24 * length_squared(ray.given.direction)) {
        return {length(f) < c.radius ? Interval{-kInfinity, kInfinity} : Interval{}};
    }
    const double middle = -dot(f, d) / dd;
    return within(middle, length(f + middle * d), c.radius, std::sqrt(dd));
}

/// What is common to both.
Interval meeting(const Interval& a, const Interval& b) {
    return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

void add_pieces(const LocalRay& ray, std::uint32_t number, std::vector<Piece>& pieces) {
    const BlobComponent& c = ray.blob.components[number];
    constexpr Interval kWholeLine{-kInfinity, kInfinity};
    const auto add = [&](Region region, const Interval& part, const Bump& bump) {
        const Interval t = meeting(part, bump.t);
        if (t.lo < t.hi && std::isfinite(t.lo) && std::isfinite(t.hi)) {
            pieces.push_back({number, region, t.lo, t.hi, bump});
        }
    };
    if (!c.rod) return add(Region::Base, kWholeLine, within_ball(ray, c.base, c.radius));
    const Vec3 e = c.top - c.base;
    const double start = dot(ray.o - c.base, e), speed = dot(ray.given.direction, e);
    Interval before = kWholeLine, between = before, behind = before;
    if (speed == 0.0) {
        if (start >= 0.0) before = {};
        if (start < 0.0 || start > length_squared(e)) between = {};
        if (start <= length_squared(e)) behind = {};
    } else {
        const double at_base = -start / speed, at_top = (length_squared(e) - start) / speed;
        between = {std::min(at_base, at_top), std::max(at_base, at_top)};
        before = {-kInfinity, between.lo};
        behind = {between.hi, kInfinity};
        if (speed < 0.0) std::swap(before, behind);
    }
    add(Region::Base, before, within_ball(ray, c.base, c.radius));
    add(Region::Middle, between, within_rod(ray, c));
    add(Region::Top, behind, within_ball(ray, c.top, c.radius));
}

/// What one ray needs; kept from ray to ray so that nothing is allocated.
struct Workspace {
    std::vector<Piece> pieces;
    std::vector<Event> events;
    std::vector<std::uint32_t> active;
};

/// The crossings of the spans, one after another.
class SpanWalk {
  public:
    SpanWalk(const LocalRay& ray, const Workspace& work, ShapeHits& hits)
        : ray_(ray), work_(work), hits_(hits) {}

    /// The components in work.active hold on [t0, t1].
    void span(double t0, double t1) {
        gap(t0);
        last_ = t1;
        double most = 0.0, here = 0.0;
        for (const std::uint32_t i : work_.active) {
            const Piece& piece = work_.pieces[i];
            const BlobComponent& c = ray_.blob.components[piece.component];
            const double s = std::max(0.0, c.strength);
            most += s;
            if (piece.bump.known()) {
                // With more room than its numbers round.
                const double room = 0x1p-46 * (ray_.far + ray_.blob.reach) / c.radius;
                const double q = std::fmax(0.0, piece.bump.largest(t0, t1)) + room;
                here += s * q * q;
            } else {
                here += s;
            }
        }
        // Too weak together.
        if (here < 0.999 * ray_.blob.threshold) {
            if (skipped_) inside_ = skipped_ = false;
            return leave(t0);
        }
        SignChanges<4> changes;
        find_certified_sign_changes<4>(
            [&]<class Real>(BernsteinPolynomial<Real, 4>& p) {
                p.degree = 4;
                p.error = 0.0;
                for (int k = 0; k <= 4; ++k) p.b[k] = Real(ray_.blob.threshold);
                for (const std::uint32_t i : work_.active) ray_.add(work_.pieces[i], t0, t1, p);
                const double terms = ray_.blob.threshold + most;
                p.error *= 1.0 + kRounding<Real> * double(work_.active.size());
                p.error += kRounding<Real> * 4.0 * double(work_.active.size()) * terms;
            },
            changes);
        if (skipped_) inside_ = changes.negative_at_start;
        skipped_ = false;
        if (changes.negative_at_start != inside_) turn(t0);
        for (int k = 0; k < changes.count; ++k) turn(t0 + changes.u[k] * (t1 - t0));
    }
    /// A span that ends before the ray begins.
    void skip(double t1) {
        last_ = t1;
        skipped_ = true;
    }
    /// Nothing lies between the last span and t.
    void gap(double t) {
        if (t == last_) return;
        if (skipped_) inside_ = skipped_ = false;
        leave(last_);
    }
    /// From here on there is nothing.
    void leave(double t) {
        if (inside_) turn(t);
    }

  private:
    void turn(double t) {
        const double at = ray_.shift + t;
        inside_ = !inside_;
        if (ray_.given.covers(at)) hits_.push_back({at, 0, inside_ ? -1.0 : 1.0, 0});
    }

    const LocalRay& ray_;
    const Workspace& work_;
    ShapeHits& hits_;
    double last_ = -kInfinity;
    bool inside_ = false;
    bool skipped_ = false;  ///< whether it is inside here is not known
};

struct Density {
    double value = 0;
    Vec3 gradient{};
    double rounding = 0;
};

Density density_at(const Blob& blob, const Vec3& p) {
    Density sum;
    blob.tree->for_point(p, [&](std::uint32_t i) {
        const BlobComponent& c = blob.components[i];
        Vec3 nearest = c.base;
        if (c.rod) {
            const Vec3 e = c.top - c.base;
            nearest += std::clamp(dot(p - c.base, e) / length_squared(e), 0.0, 1.0) * e;
        }
        const Vec3 r = p - nearest;
        const double q = 1.0 - length_squared(r) / (c.radius * c.radius);
        if (q <= 0.0) return;
        sum.value += c.strength * q * q;
        sum.gradient -= (4.0 * c.strength * q / (c.radius * c.radius)) * r;
        sum.rounding += std::abs(c.strength) * (8.0 + 4.0 * max_component(abs(p)) / c.radius);
    });
    return sum;
}

}  // namespace

void Blob::prepare() {
    std::vector<Box3> boxes;
    bounds = {};
    for (const BlobComponent& c : components) {
        const Vec3 half{c.radius, c.radius, c.radius};
        Box3 box = outward_box(c.base, half);
        if (c.rod) box.include(outward_box(c.top, half));
        bounds.include(box);
        boxes.push_back(box);
    }
    reach = std::max(max_component(abs(bounds.lo)), max_component(abs(bounds.hi)));
    tree = std::make_shared<const BlobTree>(boxes);
}

void Blob::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    if (components.empty()) return checks.fail("at least one sphere or cylinder must be given");
    checks.length("threshold", threshold);
    for (const BlobComponent& c : components) {
        checks.point("center or base of a component", c.base);
        if (c.rod) checks.point("top of a component", c.top);
        checks.length("radius of a component", c.radius);
        if (!(std::abs(c.strength) <= kMaxCoordinate)) {
            checks.fail("strength of a component must be a number below 1e70");
        }
        if (checks.ok() && c.rod) {
            checks.length("distance from base to top of a component", length(c.top - c.base));
        }
        if (!checks.ok()) return;
    }
}

Interval Blob::extent(const Vec3& axis) const {
    Interval range;
    for (const BlobComponent& c : components) {
        const double half = c.radius * length(axis);
        range = hull(range, outward_extent(axis, c.base, half));
        if (c.rod) range = hull(range, outward_extent(axis, c.top, half));
    }
    return range;
}

namespace {

/// So many components are looked at one after the other; beyond that the tree is faster.
constexpr std::size_t kFewComponents = 64;

/// The pieces of all components that the line may meet.
void collect_pieces(const LocalRay& local, std::vector<Piece>& pieces) {
    const Blob& blob = local.blob;
    const Vec3& d = local.given.direction;
    const double pad = 0x1p-48 * (local.far + blob.reach);
    if (blob.components.size() > kFewComponents) {
        blob.tree->for_line(local.o, d, pad,
                            [&](std::uint32_t i) { add_pieces(local, i, pieces); });
        return;
    }
    const double dd = length_squared(d);
    for (std::uint32_t i = 0; i < blob.components.size(); ++i) {
        const BlobComponent& c = blob.components[i];
        const double near = c.radius + pad;
        if (!c.rod && length_squared(cross(local.o - c.base, d)) > near * near * dd) continue;
        add_pieces(local, i, pieces);
    }
}

ALHAZEN_FOR_EACH_INSTRUCTION_SET
void intersect_blob(const Blob& blob, const Ray& ray, Workspace& work, ShapeHits& hits) {
    work.pieces.clear();
    work.active.clear();
    const LocalRay local(blob, ray);
    if (!is_finite(local.o)) return;
    collect_pieces(local, work.pieces);
    work.events.resize(2 * work.pieces.size());
    Event* events = work.events.data();
    for (std::uint32_t i = 0; i < work.pieces.size(); ++i) {
        *events++ = {work.pieces[i].in, i, true};
        *events++ = {work.pieces[i].out, i, false};
    }
    std::sort(work.events.begin(), work.events.end(), [](const Event& a, const Event& b) {
        return a.t != b.t ? a.t < b.t : a.piece < b.piece;
    });
    SpanWalk walk(local, work, hits);
    double last = 0.0;
    for (const Event& event : work.events) {
        if (!work.active.empty() && last < event.t) {
            if (event.t + local.shift < ray.t_min) {
                walk.skip(event.t);
            } else if (last + local.shift > ray.t_max || hits.enough()) {
                return walk.gap(last);
            } else {
                walk.span(last, event.t);
            }
        }
        last = event.t;
        if (event.begins) {
            work.active.push_back(event.piece);
        } else {
            work.active.erase(std::find(work.active.begin(), work.active.end(), event.piece));
        }
    }
    walk.gap(kInfinity);
}

}  // namespace

void Blob::intersect(const Ray& ray, ShapeHits& hits) const {
    static thread_local Workspace work;
    intersect_blob(*this, ray, work, hits);
}

ShapeSurface plain_surface(const Blob& shape, const Ray& ray, const ShapeHit& hit) {
    ShapeSurface surface;
    surface.point = ray.at(hit.t);
    Density there = density_at(shape, surface.point);
    double steepness = length(there.gradient);
    if (steepness > 0.0) {
        // One step to the surface; no farther than what the ray rounds.
        const double off = (shape.threshold - there.value) / steepness;
        const double room = 0x1p-48 * (max_component(abs(ray.origin)) + shape.reach);
        surface.point += (std::clamp(off, -room, room) / steepness) * there.gradient;
        there = density_at(shape, surface.point);
        steepness = length(there.gradient);
    }
    surface.normal = unit_or(-there.gradient, -unit_or(ray.direction, {0, 0, 1}));
    // Whether the ray enters here (v = -1) or leaves is known from all its crossings.
    if (dot(surface.normal, ray.direction) * hit.v < 0.0) surface.normal = -surface.normal;
    surface.shading_normal = surface.normal;
    // What the density rounds, over its steepness; where that hardly tells, the last digits of all.
    const double most = gamma_bound(48) * shape.reach;
    const double off = 0x1p-53 * there.rounding / steepness + gamma_bound(4) * shape.reach;
    const double error = off < most ? off : most;
    surface.error = {error, error, error};
    return surface;
}

ShapeSurface Blob::surface(const Ray& ray, const ShapeHit& hit) const {
    ShapeSurface surface = plain_surface(*this, ray, hit);
    const Vec3 from_center = unit_or(surface.point - bounds.center(), {1, 0, 0});
    surface.uv = {turn_fraction(from_center.x, from_center.y),
                  0.5 + std::atan2(from_center.z, std::hypot(from_center.x, from_center.y)) / kPi};
    return surface;
}

}  // namespace alhazen
