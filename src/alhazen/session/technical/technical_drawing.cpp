#include "alhazen/session/technical/technical_drawing.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "alhazen/base/error.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/renderers/beam_tracing/beam_tree.h"
#include "alhazen/session/technical/feature_curves.h"
#include "alhazen/session/technical/line_chains.h"

namespace alhazen {

namespace {

/// Distance of tested points of a curve, and precision of its visible ends; pixels.
constexpr double kStep = 1.5, kNear = 0.02;
/// Least distance of tested points from the surfaces: relative to the size of the scene, and to
/// coordinates, whose rounding moves hits by some units of the last place.
constexpr double kLift = 1e-6, kRounding = 1e-13;

/// The mapping from space to the picture.
class CurveView {
  public:
    CurveView(const Camera& camera, int width, int height)
        : view_(eye_view(camera)), x_(0.5 * width), y_(0.5 * height) {}

    [[nodiscard]] const BeamApex& eye() const { return view_.apex; }
    /// Homogeneous coordinates of the picture: the pixel is (x / z, y / z), z > 0 in front of the
    /// eye.
    [[nodiscard]] Vec3 point(const Vec3& p) const { return to_picture(view_.projection(p)); }
    [[nodiscard]] Vec3 vector(const Vec3& v) const {
        return to_picture(view_.projection(v) - view_.projection({0, 0, 0}));
    }
    [[nodiscard]] Vec2 pixel(const Vec3& p) const {
        const Vec3 h = point(p);
        return {h.x / h.z, h.y / h.z};
    }
    /// The ray that sees a point; the point is at t = 1.
    [[nodiscard]] Ray ray_to(const Vec3& p) const {
        if (view_.apex.weight != 0.0) return {view_.apex.at, p - view_.apex.at};
        // Parallel rays start in the plane of the camera.
        const Vec3 along = -view_.apex.at;
        const double depth = view_.start.at(p) / dot(view_.start.normal, along);
        return {p - depth * along, depth * along};
    }
    [[nodiscard]] bool is_before(const Vec3& p) const {
        return view_.has_start ? view_.start.at(p) > 0.0 : point(p).z > 0.0;
    }

  private:
    [[nodiscard]] Vec3 to_picture(const Vec3& w) const {
        return {x_ * (w.z + w.x / kBeamFilm), y_ * (w.z - w.y / kBeamFilm), w.z};
    }
    BeamView view_;
    double x_, y_;
};

Vec3 at(const CurveForm& form, bool round, double t) {
    return round ? form.origin + std::cos(t) * form.u + std::sin(t) * form.v
                 : form.origin + t * form.u;
}

class CurveDrawer {
  public:
    CurveDrawer(const Scene& scene, const CurveView& view, bool hidden, double size)
        : scene_(scene), view_(view), hidden_(hidden), size_(size) {}

    void draw(const FeatureCurve& curve) {
        const double pixels = length_of(curve);
        const int steps = std::clamp(static_cast<int>(std::ceil(pixels / kStep)), 1, 4000);
        const double step = (curve.to - curve.from) / steps;
        // Visibility is tested in the middles of steps.
        double begin = curve.from;
        int state = state_of(curve, curve.from + 0.5 * step);
        for (int k = 1; k < steps; ++k) {
            const double here = curve.from + (k + 0.5) * step;
            const int next = state_of(curve, here);
            if (next == state) continue;
            double lo = here - step, hi = here;
            while ((hi - lo) * pixels > kNear * (curve.to - curve.from)) {
                const double middle = 0.5 * (lo + hi);
                (state_of(curve, middle) == state ? lo : hi) = middle;
            }
            add(curve, state, begin, lo);
            begin = hi;
            state = next;
        }
        add(curve, state, begin, curve.to);
    }
    [[nodiscard]] std::vector<DrawingLine> take() { return std::move(lines_); }

  private:
    enum State { kBehind, kHidden, kSeen };

    /// Length in pixels. Each of the parts is limited, so that the number of steps does not grow
    /// with what lies outside the picture.
    [[nodiscard]] double length_of(const FeatureCurve& curve) const {
        const int parts = curve.round ? 64 : 8;
        double sum = 0.0;
        for (int k = 0; k < parts; ++k) {
            const double step = (curve.to - curve.from) / parts;
            const Vec3 a = at(curve.points, curve.round, curve.from + k * step);
            const Vec3 b = at(curve.points, curve.round, curve.from + (k + 1) * step);
            if (!view_.is_before(a) || !view_.is_before(b)) {
                sum += 100.0;
                continue;
            }
            const Vec2 d = view_.pixel(b) - view_.pixel(a);
            sum += std::min(std::hypot(d.x, d.y), 2000.0);
        }
        return sum;
    }

    [[nodiscard]] int state_of(const FeatureCurve& curve, double t) const {
        const Vec3 p = at(curve.points, curve.round, t);
        if (!view_.is_before(p)) return kBehind;
        const double reach = length(p) + view_.eye().weight * length(view_.eye().at);
        const double off = std::max({3.0 * curve.off, kLift * size_, kRounding * reach});
        const Vec3 n = off * unit_or(at(curve.out, curve.round, t), {});
        const Vec3 m = off * unit_or(at(curve.other_out, curve.round, t), {});
        for (const Vec3& lifted : {p + n + m, p + n, p + m}) {
            if (is_free(lifted, 2.0 * off)) return kSeen;
        }
        return kHidden;
    }
    [[nodiscard]] bool is_free(const Vec3& p, double slack) const {
        Ray ray = view_.ray_to(p);
        const double distance = length(ray.direction);
        ray.direction = ray.direction / distance;
        ray.t_min = 0.0;
        // Surfaces that touch the curve do not hide it.
        ray.t_max = distance - slack;
        if (!(ray.t_max > 0.0)) return true;
        return !scene_.aggregate->occluded(ray, {nullptr, mask_of(RayKind::Eye)});
    }

    void add(const FeatureCurve& curve, int state, double from, double to) {
        if (state == kBehind || (state == kHidden && !hidden_) || !(from < to)) return;
        DrawingLine line;
        line.style = state == kSeen ? curve.style : LineStyle::Hidden;
        if (!curve.round) {
            line.points = {view_.pixel(at(curve.points, false, from)),
                           view_.pixel(at(curve.points, false, to))};
        } else if (!add_arc(curve, from, to, line)) {
            constexpr int kParts = 128;
            for (int k = 0; k <= kParts; ++k) {
                const Vec3 p = at(curve.points, true, from + (to - from) * k / kParts);
                if (view_.is_before(p)) line.points.push_back(view_.pixel(p));
            }
        }
        lines_.push_back(std::move(line));
    }

    /// The image of a circle under a projection: its middle is the image of the pole of the line
    /// that becomes infinite; two chords through the pole, one of them through the middle of the
    /// circle, become conjugate diameters.
    bool add_arc(const FeatureCurve& curve, double from, double to, DrawingLine& line) const {
        const Vec3 o = view_.point(curve.points.origin), u = view_.vector(curve.points.u),
                   v = view_.vector(curve.points.v);
        if (!(o.z > 1.0001 * std::hypot(u.z, v.z))) return false;
        const auto image = [&](double a, double b) {
            const Vec3 h = o + a * u + b * v;
            return Vec2{h.x / h.z, h.y / h.z};
        };
        const double a = -u.z / o.z, b = -v.z / o.z, reach = std::hypot(a, b);
        const Vec2 along = reach > 1e-12 ? Vec2{a / reach, b / reach} : Vec2{1, 0};
        const double half = std::sqrt(1.0 - reach * reach);
        DrawingArc arc;
        arc.center = image(a, b);
        arc.u = image(along.x, along.y) - arc.center;
        arc.v = image(a - half * along.y, b + half * along.x) - arc.center;
        const double area = arc.u.x * arc.v.y - arc.u.y * arc.v.x;
        if (!(std::abs(area) > 1e-6)) return false;
        const auto angle = [&](double t) {
            const Vec2 d = image(std::cos(t), std::sin(t)) - arc.center;
            return std::atan2((arc.u.x * d.y - arc.u.y * d.x) / area,
                              (d.x * arc.v.y - d.y * arc.v.x) / area);
        };
        const auto turned = [](double x) { return x - 2 * kPi * std::floor(x / (2 * kPi)); };
        arc.from = angle(from);
        const bool whole = to - from > 2 * kPi - 1e-9;
        const double middle = turned(angle(0.5 * (from + to)) - arc.from);
        const double end = whole ? 2 * kPi : turned(angle(to) - arc.from);
        arc.to = arc.from + (whole || middle < end ? end : end - 2 * kPi);
        line.arc = arc;
        return true;
    }

    const Scene& scene_;
    const CurveView& view_;
    bool hidden_;
    double size_;
    std::vector<DrawingLine> lines_;
};

/// The size of a scene; that of its curves if it has no bounds.
double size_of_all(const Scene& scene, std::span<const FeatureCurve> curves) {
    Box3 box = scene.aggregate->box();
    if (box.bounded()) return length(box.size());
    box = Box3();
    for (const FeatureCurve& c : curves) {
        for (const double t : {c.from, 0.5 * (c.from + c.to), c.to}) {
            box.include(at(c.points, c.round, t));
        }
    }
    return box.bounded() ? length(box.size()) : 0.0;
}

}  // namespace

Drawing technical_drawing(const LoadedScene& loaded, const RenderOptions& options,
                          const TechnicalOptions& technical) {
    if (!loaded.scene.aggregate) {
        throw Error(ErrorKind::Usage, "technical drawings need the aggregate of the scene");
    }
    const CameraDescription& camera = find_camera(loaded.scene, options.camera);
    const FrameSize frame = frame_size(loaded.description.picture, options, camera.aspect);
    const double aspect = static_cast<double>(frame.width) / frame.height;
    const CurveView view(with_aspect(camera.camera, camera.aspect, aspect), frame.width,
                         frame.height);
    Drawing drawing;
    drawing.width = frame.width;
    drawing.height = frame.height;
    const std::vector<FeatureCurve> curves =
        feature_curves(loaded.description, view.eye(), technical.tolerance, drawing.notes);
    CurveDrawer drawer(loaded.scene, view, technical.hidden, size_of_all(loaded.scene, curves));
    for (const FeatureCurve& curve : curves) {
        if (options.stop != nullptr && options.stop->requested()) break;
        drawer.draw(curve);
    }
    drawing.lines = chained(drawer.take());
    std::stable_sort(drawing.lines.begin(), drawing.lines.end(),
                     [](const DrawingLine& a, const DrawingLine& b) { return a.style < b.style; });
    return drawing;
}

}  // namespace alhazen
