#include "alhazen/shapes/exact_surface.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// The scale factor of a similarity transform; empty for other transforms.
std::optional<double> similarity(const Mat3& m) {
    const double xx = length_squared(m.x_axis), yy = length_squared(m.y_axis),
                 zz = length_squared(m.z_axis), mean = (xx + yy + zz) / 3.0;
    const double off = std::fmax(
        std::fmax(std::abs(xx - mean), std::fmax(std::abs(yy - mean), std::abs(zz - mean))),
        std::fmax(std::abs(dot(m.x_axis, m.y_axis)),
                  std::fmax(std::abs(dot(m.y_axis, m.z_axis)), std::abs(dot(m.z_axis, m.x_axis)))));
    if (!(off <= 4e-15 * mean)) return std::nullopt;
    return std::sqrt(mean);
}

Mat3 transposed(const Mat3& m) {
    return {{m.x_axis.x, m.y_axis.x, m.z_axis.x},
            {m.x_axis.y, m.y_axis.y, m.z_axis.y},
            {m.x_axis.z, m.y_axis.z, m.z_axis.z}};
}

bool has_mixed_terms(const QuadricForm& f) {
    return f.xy != 0.0 || f.yz != 0.0 || f.zx != 0.0;
}

/// The form without mixed terms as the sum of signs_i (rows_i x)^2 in world space.
std::array<Vec3, 3> rows_of(const Mat3& local_from_space, const QuadricForm& f) {
    const Mat3 rows = transposed(local_from_space);
    return {std::sqrt(std::abs(f.xx)) * rows.x_axis, std::sqrt(std::abs(f.yy)) * rows.y_axis,
            std::sqrt(std::abs(f.zz)) * rows.z_axis};
}
Vec3 signs_of(const QuadricForm& f) {
    const auto sign = [](double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; };
    return {sign(f.xx), sign(f.yy), sign(f.zz)};
}

/// True if the form's axes in world space are known to too few digits: rows of different signs that
/// are not perpendicular, with a ratio whose square leaves less than about 5 digits.
bool is_too_slender(const Mat3& local_from_space, const QuadricForm& f) {
    constexpr double kMostRatio = 1e5;
    if (has_mixed_terms(f)) return false;
    const std::array<Vec3, 3> rows = rows_of(local_from_space, f);
    if (eigensystem_of_rows(rows, signs_of(f))) return false;
    const double sum = length_squared(rows[0]) + length_squared(rows[1]) + length_squared(rows[2]);
    // Flat directions are skipped.
    const auto entry = [&](int i, int k) {
        const double product = dot(rows[i], rows[k]);
        return i == k && product == 0.0 ? sum : product;
    };
    const Vec3 squares = eigensystem({{entry(0, 0), entry(1, 0), entry(2, 0)},
                                      {entry(0, 1), entry(1, 1), entry(2, 1)},
                                      {entry(0, 2), entry(1, 2), entry(2, 2)}})
                             .values;
    const double least = std::fmin(squares.x, std::fmin(squares.y, squares.z));
    return !(least * kMostRatio * kMostRatio > max_component(squares));
}

/// Eigensystem, in world space, of a form given in a local frame.
Eigensystem eigensystem_of(const Mat3& local_from_space, const QuadricForm& f, const Mat3& a) {
    if (!has_mixed_terms(f)) {
        const auto own = eigensystem_of_rows(rows_of(local_from_space, f), signs_of(f));
        if (own) return *own;
    }
    const Mat3 rows = transposed(local_from_space);
    const Mat3 half = rows * (a * local_from_space);
    Eigensystem own = eigensystem({0.5 * (half.x_axis + transposed(half).x_axis),
                                   0.5 * (half.y_axis + transposed(half).y_axis),
                                   0.5 * (half.z_axis + transposed(half).z_axis)});
    // Sets eigenvalues of flat directions, which are mere rounding, to zero.
    const double least =
        8 * std::numeric_limits<double>::epsilon() * max_component(abs(own.values));
    for (int i = 0; i < 3; ++i) {
        if (std::abs(own.values[i]) < least) own.values[i] = 0.0;
    }
    return own;
}

std::string too_many_planes(std::size_t count) {
    if (count <= ClippedRegion::kMostPlanes) return {};
    return "has more than " + std::to_string(ClippedRegion::kMostPlanes) + " planes";
}

bool has_lines_only(const Profile& profile) {
    for (const ProfileCurve& curve : profile.curves) {
        if (!curve.line) return false;
    }
    return true;
}

/// The profile with open loops, which begin and end on the axis, closed along the axis.
Profile with_axis(const Profile& profile) {
    Profile closed = profile;
    std::size_t begin = 0;
    for (const std::size_t end : profile.loop_ends) {
        const Vec2 first = profile.curves[begin].p[0], last = profile.curves[end - 1].p[3];
        if (first != last) closed.curves.push_back(line_curve(last, first));
        begin = end;
    }
    return closed;
}

/// True if the right side of a line of the profile is inside: the normal at its middle crosses an
/// odd number of other lines.
bool lies_inside(const Profile& profile, const ProfileCurve& line) {
    const double dx = line.p[3].x - line.p[0].x, dy = line.p[3].y - line.p[0].y;
    const double mx = 0.5 * (line.p[0].x + line.p[3].x), my = 0.5 * (line.p[0].y + line.p[3].y);
    bool odd = false;
    for (const ProfileCurve& other : profile.curves) {
        if (&other == &line) continue;
        // Coordinates of a point along the line, and to its right, from its middle.
        const auto along = [&](const Vec2& p) { return dx * (p.x - mx) + dy * (p.y - my); };
        const auto aside = [&](const Vec2& p) { return dy * (p.x - mx) - dx * (p.y - my); };
        const double a = along(other.p[0]), b = along(other.p[3]);
        if ((a > 0.0) == (b > 0.0)) continue;
        const double s = a / (a - b);
        odd ^= (1.0 - s) * aside(other.p[0]) + s * aside(other.p[3]) > 0.0;
    }
    return odd;
}

std::size_t plane_count(const ClippedQuadric& solid) {
    std::size_t count = solid.planes.size();
    for (int k = 0; k < 3; ++k) {
        count += std::isfinite(solid.clip_box.lo[k]) ? 1 : 0;
        count += std::isfinite(solid.clip_box.hi[k]) ? 1 : 0;
    }
    return count;
}

template <class S>
std::string refusal_of(const S& shape, const Affine& world) {
    constexpr const char* kUnknown = "is of a kind without a closed form";
    constexpr const char* kSlender = "is stretched obliquely, with an axis ratio above 1e5";
    if constexpr (std::is_same_v<S, Torus>) {
        return similarity(world.linear) ? "" : "is placed with different scales along its axes";
    } else if constexpr (std::is_same_v<S, Tgc>) {
        return shape.quartic ? "has ends of different proportions: a surface of degree 4" : "";
    } else if constexpr (std::is_same_v<S, Polyhedron>) {
        return too_many_planes(shape.faces.size());
    } else if constexpr (requires { plane_count(shape.solid); }) {
        const Mat3 local = shape.solid.frame.local_from_object * inverse(world).linear;
        if (is_too_slender(local, shape.solid.quadric.form())) return kSlender;
        return too_many_planes(plane_count(shape.solid));
    } else if constexpr (std::is_same_v<S, Cone>) {
        const Frustum& f = shape.frustum;
        const Mat3 local = transposed({f.x_axis, f.y_axis, f.axis}) * inverse(world).linear;
        return is_too_slender(local, {1, 1, -f.slope * f.slope}) ? kSlender : "";
    } else if constexpr (std::is_same_v<S, Lathe> || std::is_same_v<S, Prism>) {
        return has_lines_only(shape.profile) ? "" : "has curves in its profile";
    } else if constexpr (std::is_same_v<S, Sphere> || std::is_same_v<S, Plane> ||
                         std::is_same_v<S, HalfSpace> || std::is_same_v<S, Disc> ||
                         std::is_same_v<S, Rectangle> || std::is_same_v<S, BoxShape> ||
                         std::is_same_v<S, Cylinder> || std::is_same_v<S, Polygon>) {
        return {};
    } else {
        return kUnknown;
    }
}

}  // namespace

std::string nearest_refusal(const AnyShape& shape, const Affine& world_from_shape) {
    return std::visit([&](const auto& s) { return refusal_of(s, world_from_shape); },
                      static_cast<const AnalyticShapes::Variant&>(shape));
}

/// Appends the pieces of a shape in world space.
class PieceMaker {
  public:
    PieceMaker(const Placement& world, std::vector<ExactSurface::Piece>& pieces)
        : world_(world), pieces_(pieces) {}

    void add(const Sphere& s) {
        if (const auto scale = similarity(world_.outer_from_inner.linear)) {
            pieces_.emplace_back(ExactSurface::Ball{point(s.center), *scale * s.radius});
            return;
        }
        QuadricForm form;
        form.c = -s.radius * s.radius;
        add_quadric({s.center, {}}, form, {}, true);
    }
    void add(const Torus& s) {
        const double scale = similarity(world_.outer_from_inner.linear).value_or(1.0);
        pieces_.emplace_back(ExactSurface::Ring{
            point(s.center), normalize(world_.outer_from_inner.vector(s.unit_axis)),
            scale * s.major_radius, scale * s.minor_radius});
    }
    void add(const Plane& s) { add_wall(s.point, s.unit_normal); }
    void add(const HalfSpace& s) { add_wall(s.face.point, s.face.unit_normal); }
    void add(const Disc& s) {
        const Vec3 y = cross(s.unit_normal, s.u_axis);
        const SolidFrame frame(s.center, {s.u_axis, y, s.unit_normal});
        QuadricForm form{1, 1, 0};
        form.c = -s.radius * s.radius;
        const auto region = [&] {
            return std::make_shared<const ClippedRegion>(
                region_of(frame, form, {{{0, 0, 1}, 0}}, true));
        };
        ExactSurface::Annulus ring{point(s.center), region(), nullptr};
        form.c = -s.inner_radius * s.inner_radius;
        if (s.inner_radius > 0.0) ring.hole = region();
        pieces_.emplace_back(std::move(ring));
    }
    void add(const Rectangle& s) {
        add_polygon(
            {s.corner, s.corner + s.edge_u, s.corner + s.edge_u + s.edge_v, s.corner + s.edge_v},
            {}, s.corner, s.unit_normal);
    }
    void add(const Polygon& s) { add_polygon(s.vertices, s.loop_ends, s.point, s.normal); }
    void add(const BoxShape& s) {
        const SolidFrame frame(0.5 * (s.lo + s.hi), {});
        const Vec3 half = 0.5 * (s.hi - s.lo);
        std::vector<ClippedRegion::Plane> planes;
        for (int k = 0; k < 3; ++k) {
            for (const double side : {-1.0, 1.0}) {
                Vec3 normal;
                normal[k] = side;
                planes.push_back(plane_of(frame, {normal, half[k]}));
            }
        }
        add_region(frame, ClippedRegion(std::move(planes)));
    }
    void add(const Polyhedron& s) {
        const SolidFrame frame(s.bounds.center(), {});
        std::vector<ClippedRegion::Plane> planes;
        for (const OrientedPlane& face : s.faces) {
            planes.push_back(
                plane_of(frame, {face.normal, dot(face.normal, face.point - frame.origin)}));
        }
        add_region(frame, ClippedRegion(std::move(planes)));
    }
    void add(const Cylinder& s) { add_frustum(s.frustum, s.capped); }
    void add(const Cone& s) { add_frustum(s.frustum, s.capped); }
    void add(const Lathe& s) {
        const Profile closed = s.is_closed ? with_axis(s.profile) : s.profile;
        for (std::size_t i = 0; i < closed.curves.size(); ++i) {
            const ProfileCurve& curve = closed.curves[i];
            const Vec2 &a = curve.p[0], &b = curve.p[3];
            if (a.x == 0.0 && b.x == 0.0) continue;  // on the axis
            // The side of the line from a to b that is inside.
            const bool to_left = s.is_closed && lies_inside(closed, curve);
            if (a.y != b.y) {
                const bool up = a.y < b.y;
                const Vec2 &low = up ? a : b, &high = up ? b : a;
                add_frustum(Frustum({0, 0, low.y}, {0, 0, high.y}, low.x, high.x), false,
                            s.is_closed && up == to_left);
            } else if (a.x != b.x) {
                Disc disc;
                disc.center = {0, 0, a.y};
                if (s.is_closed) disc.normal = {0, 0, (a.x < b.x) == to_left ? 1.0 : -1.0};
                disc.radius = std::fmax(a.x, b.x);
                disc.inner_radius = std::fmin(a.x, b.x);
                disc.prepare();
                add(disc);
            }
        }
    }
    void add(const Prism& s) {
        const auto lifted = [&](const Vec2& p, bool top) {
            const double scale = top ? s.top_scale : 1.0;
            return Vec3{scale * p.x, scale * p.y, top ? s.h1 : s.h0};
        };
        for (const bool top : {false, true}) {
            if (top && s.top_scale == 0.0) continue;
            std::vector<Vec3> corners;
            for (const ProfileCurve& curve : s.profile.curves) {
                corners.push_back(lifted(curve.p[0], top));
            }
            const Vec3 at = corners.front();
            add_polygon(std::move(corners), s.profile.loop_ends, at, {0, 0, top ? 1.0 : -1.0});
        }
        for (const ProfileCurve& curve : s.profile.curves) {
            const Vec2 &a = curve.p[0], &b = curve.p[3];
            std::vector<Vec3> corners{lifted(a, false), lifted(b, false), lifted(b, true),
                                      lifted(a, true)};
            Vec3 normal =
                cross(corners[1] - corners[0],
                      s.top_scale == 0.0 ? corners[2] - corners[0] : corners[3] - corners[0]);
            if (normal == Vec3{}) continue;
            if (lies_inside(s.profile, curve)) normal = -normal;
            const Vec3 at = corners.front();
            add_polygon(std::move(corners), {}, at, normalize(normal));
        }
    }
    /// Ellipsoids, and all shapes with a clipped quadric.
    template <class S>
    void add(const S& s) {
        if constexpr (requires { plane_count(s.solid); }) {
            const ClippedQuadric& solid = s.solid;
            std::vector<ClipPlane> planes = solid.planes;
            for (int k = 0; k < 3; ++k) {
                Vec3 axis;
                axis[k] = 1.0;
                if (std::isfinite(solid.clip_box.hi[k])) {
                    planes.push_back({axis, solid.clip_box.hi[k]});
                }
                if (std::isfinite(solid.clip_box.lo[k])) {
                    planes.push_back({-axis, -solid.clip_box.lo[k]});
                }
            }
            add_quadric(solid.frame, solid.quadric.form(), planes, solid.capped);
        }
    }

  private:
    [[nodiscard]] Vec3 point(const Vec3& p) const { return world_.outer_from_inner.point(p); }
    /// Linear map from world space to a frame of the shape.
    [[nodiscard]] Mat3 local_from_space(const SolidFrame& frame) const {
        return frame.local_from_object * world_.inner_from_outer.linear;
    }
    [[nodiscard]] ClippedRegion::Plane plane_of(const SolidFrame& frame,
                                                const ClipPlane& plane) const {
        const Vec3 normal = transpose_times(local_from_space(frame), plane.normal);
        const double size = length(normal);
        return {normal / size, plane.offset / size};
    }
    [[nodiscard]] ClippedRegion region_of(const SolidFrame& frame, const QuadricForm& f,
                                          const std::vector<ClipPlane>& local, bool capped) const {
        const Mat3 m = local_from_space(frame);
        const Mat3 a{{f.xx, f.xy, f.zx}, {f.xy, f.yy, f.yz}, {f.zx, f.yz, f.zz}};
        std::vector<ClippedRegion::Plane> planes;
        for (const ClipPlane& plane : local) planes.push_back(plane_of(frame, plane));
        return {eigensystem_of(m, f, a),
                transpose_times(m, {f.x, f.y, f.z}),
                f.c,
                std::move(planes),
                capped,
                apex_of(frame, f, a)};
    }
    /// Relative to the shape's origin in world space, the point where f and its gradient are 0.
    [[nodiscard]] std::optional<Vec3> apex_of(const SolidFrame& frame, const QuadricForm& f,
                                              const Mat3& a) const {
        const Vec3 b{f.x, f.y, f.z};
        const Vec3 center = -(inverse(a) * b);
        if (!is_finite(center)) return std::nullopt;
        constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
        const double size = dot(abs(b), abs(center)) + std::abs(f.c);
        if (std::abs(dot(b, center) + f.c) > kRounding * size) return std::nullopt;
        return world_.outer_from_inner.vector(frame.object_from_local * center);
    }
    void add_quadric(const SolidFrame& frame, const QuadricForm& form,
                     const std::vector<ClipPlane>& planes, bool capped, bool hollow = false) {
        add_region(frame, region_of(frame, form, planes, capped), hollow);
    }
    void add_region(const SolidFrame& frame, ClippedRegion region, bool hollow = false) {
        pieces_.emplace_back(ExactSurface::Clipped{
            point(frame.origin), std::make_shared<const ClippedRegion>(std::move(region)), hollow});
    }
    void add_frustum(const Frustum& f, bool capped, bool hollow = false) {
        if (const auto scale = similarity(world_.outer_from_inner.linear)) {
            pieces_.emplace_back(ExactSurface::Spindle{
                point(f.center), normalize(world_.outer_from_inner.vector(f.axis)),
                *scale * f.half_height, *scale * f.base_radius, *scale * f.top_radius, capped,
                hollow});
            return;
        }
        QuadricForm form{1, 1, -f.slope * f.slope};
        form.z = -f.middle_radius * f.slope;
        form.c = -f.middle_radius * f.middle_radius;
        add_quadric({f.center, {f.x_axis, f.y_axis, f.axis}}, form,
                    {{{0, 0, 1}, f.half_height}, {{0, 0, -1}, f.half_height}}, capped, hollow);
    }
    void add_wall(const Vec3& at, const Vec3& normal) {
        pieces_.emplace_back(ExactSurface::Wall{
            point(at), normalize(transpose_times(world_.inner_from_outer.linear, normal))});
    }
    void add_polygon(std::vector<Vec3> vertices, std::vector<std::uint32_t> loop_ends,
                     const Vec3& at, const Vec3& normal) {
        for (Vec3& v : vertices) v = point(v);
        pieces_.emplace_back(ExactSurface::Flat{std::make_shared<const FlatRegion>(
            std::move(vertices), std::move(loop_ends), point(at),
            normalize(transpose_times(world_.inner_from_outer.linear, normal)))});
    }

    const Placement& world_;
    std::vector<ExactSurface::Piece>& pieces_;
};

ExactSurface::ExactSurface(const AnyShape& shape, const Placement& world) {
    PieceMaker maker(world, pieces_);
    std::visit([&](const auto& s) { maker.add(s); },
               static_cast<const AnalyticShapes::Variant&>(shape));
}

}  // namespace alhazen
