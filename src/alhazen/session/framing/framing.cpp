#include "alhazen/session/framing/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>

#include "alhazen/base/error.h"
#include "alhazen/base/overloaded.h"
#include "alhazen/math/constants.h"
#include "alhazen/session/framing/seen_parts.h"

namespace alhazen {

namespace {

constexpr double kFieldOfView = kPi / 4;
constexpr double kMargin = 0.05;
/// Boxes flatter than this share of their other sides are seen from the front.
constexpr double kFlat = 0.25;
constexpr Rgb kHeadlight{0.75, 0.75, 0.75};
constexpr Rgb kHeadlightAmbient{0.25, 0.25, 0.25};
constexpr Rgb kHeadlightBackground{0.3, 0.3, 0.3};
/// Ambient light of a scene with lights of its own.
constexpr Rgb kSurroundings{0.1, 0.1, 0.1};

struct Turn {
    double cosine, sine;
};

/// Sine and cosine, exact at quarter turns, so that a view along an axis is exact.
Turn turn(double degrees) {
    const double quarters = degrees / 90.0;
    if (quarters == std::floor(quarters)) {
        static constexpr Turn kQuarters[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
        const double rest = std::fmod(quarters, 4.0);
        return kQuarters[static_cast<int>(rest < 0 ? rest + 4 : rest)];
    }
    const double radians = degrees * kRadiansPerDegree;
    return {std::cos(radians), std::sin(radians)};
}

/// Unit vectors of a view: from the scene to the eye, to the right and up in the picture.
struct ViewFrame {
    Vec3 to_eye, right, up;
};

ViewFrame view_frame(UpAxis up_axis, const ViewAngles& view) {
    const Turn a = turn(view.azimuth_deg);
    const Turn e = turn(view.elevation_deg);
    // In (front, side, height). `up` is the derivative of `to_eye` by elevation, which has a limit
    // at the poles.
    const auto place = [&](double front, double side, double height) {
        return up_axis == UpAxis::Z ? Vec3{front, side, height} : Vec3{side, height, front};
    };
    return {place(a.cosine * e.cosine, a.sine * e.cosine, e.sine), place(-a.sine, a.cosine, 0),
            place(-a.cosine * e.sine, -a.sine * e.sine, e.cosine)};
}

/// The least distance of an eye whose frustum, of half-width `tangent` at distance 1, contains all
/// points (across, towards the eye).
double least_distance(std::span<const Vec2> points, double tangent) {
    double right = -std::numeric_limits<double>::infinity();
    double left = right;
    for (const Vec2& p : points) {
        right = std::max(right, p.x + p.y * tangent);
        left = std::max(left, -p.x + p.y * tangent);
    }
    return (right + left) / (2.0 * tangent);
}

/// The offset of an eye at that distance for which the outermost points appear equally far from the
/// middle: the extent to the right of it falls as the eye moves right.
double centred_place(std::span<const Vec2> points, double distance) {
    double lo = points[0].x, hi = lo;
    for (const Vec2& p : points) {
        lo = std::min(lo, p.x);
        hi = std::max(hi, p.x);
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (lo + hi);
        double right = 0.0, left = 0.0;
        for (const Vec2& p : points) {
            right = std::max(right, (p.x - middle) / (distance - p.y));
            left = std::max(left, (middle - p.x) / (distance - p.y));
        }
        (right > left ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
}

double largest_side(const Vec3& size) {
    return std::max({size.x, size.y, size.z});
}

/// Points of the scene, relative to the middle of its box and in units of its size, so that no
/// product of lengths overflows or underflows.
class Cloud {
  public:
    Cloud(const Box3& box, const ViewFrame& frame) : frame_(frame), center_(box.center()) {
        const double reach = max_component(abs(center_));
        unit_ = largest_side(box.size());
        if (!(unit_ > 1e-12 * reach)) unit_ = reach > 0.0 ? 1e-6 * reach : 1.0;
    }

    void add(const Vec3& point) {
        const Vec3 p = (1.0 / unit_) * (point - center_);
        const double towards_eye = dot(frame_.to_eye, p);
        across_.push_back({dot(frame_.right, p), towards_eye});
        along_.push_back({dot(frame_.up, p), towards_eye});
    }
    /// Adds the farthest point in a direction if it is farther than all so far.
    bool add_farthest(const Vec3& direction, const FarthestPoint& farthest) {
        const double shift = dot(direction, center_);
        double known = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < across_.size(); ++i) {
            const Vec3 p = across_[i].x * frame_.right + along_[i].x * frame_.up +
                           across_[i].y * frame_.to_eye;
            known = std::max(known, dot(direction, p));
        }
        // Smaller steps do not change the picture.
        constexpr double kHardly = 1e-5;
        const auto point = farthest(direction, shift + unit_ * (known + kHardly));
        if (point) add(*point);
        return point.has_value();
    }

    [[nodiscard]] std::span<const Vec2> across() const { return across_; }
    [[nodiscard]] std::span<const Vec2> along() const { return along_; }
    [[nodiscard]] double unit() const { return unit_; }
    [[nodiscard]] const Vec3& center() const { return center_; }

  private:
    ViewFrame frame_;
    Vec3 center_;
    double unit_;
    std::vector<Vec2> across_, along_;
};

/// Place of the eye in the cloud's frame, and the half-extents of the points at distance 1.
struct EyePlace {
    double back, aside, above;
    double across, along;
};

double widest(std::span<const Vec2> points, double place, double back) {
    double most = 0.0;
    for (const Vec2& p : points) most = std::max(most, std::abs(p.x - place) / (back - p.y));
    return most;
}

EyePlace place_eye(const Cloud& cloud, double aspect) {
    const double tangent = (1.0 - 2.0 * kMargin) * std::tan(0.5 * kFieldOfView);
    double nearest = -std::numeric_limits<double>::infinity();
    for (const Vec2& p : cloud.across()) nearest = std::max(nearest, p.y);
    EyePlace eye{};
    // Without this bound, points of no width across the view would contain the eye.
    eye.back = std::max({least_distance(cloud.across(), tangent * aspect),
                         least_distance(cloud.along(), tangent), nearest + 1e-3});
    eye.aside = centred_place(cloud.across(), eye.back);
    eye.above = centred_place(cloud.along(), eye.back);
    eye.across = widest(cloud.across(), eye.aside, eye.back);
    eye.along = widest(cloud.along(), eye.above, eye.back);
    return eye;
}

CameraDescription framed_camera(const Scene& scene, UpAxis up_axis, const FramingOptions& options,
                                ViewAngles& view) {
    const SeenParts seen(*scene.aggregate);
    const Box3& box = seen.box();
    if (box.empty()) {
        throw Error(
            ErrorKind::Scene,
            scene.aggregate->box().empty()
                ? "the scene has no camera and no visible geometry to frame"
                : "the scene has no camera and no visible geometry of finite size to frame");
    }
    if (!is_finite(box.size())) {
        throw Error(ErrorKind::Scene, "the scene has no camera and is too large to be framed");
    }
    view = options.view.value_or(default_view(box, up_axis));
    CameraDescription camera;
    camera.name = "framed";
    camera.camera = framing_camera(
        box, up_axis, view, options.aspect,
        [&](const Vec3& direction, double least) { return seen.farthest(direction, least); });
    camera.aspect = options.aspect;
    return camera;
}

bool shows_without_light(const Scene& scene) {
    return std::all_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
        return m.metallic_roughness && m.metallic_roughness->unlit;
    });
}

}  // namespace

ViewAngles parse_view(const std::string& text) {
    ViewAngles view;
    const char* const end = text.data() + text.size();
    const auto azimuth = std::from_chars(text.data(), end, view.azimuth_deg);
    bool good = azimuth.ec == std::errc{} && azimuth.ptr != end && *azimuth.ptr == ',';
    if (good) {
        const auto elevation = std::from_chars(azimuth.ptr + 1, end, view.elevation_deg);
        good = elevation.ec == std::errc{} && elevation.ptr == end;
    }
    if (!good || !std::isfinite(view.azimuth_deg) || !(std::abs(view.elevation_deg) <= 90.0)) {
        throw Error(
            ErrorKind::Usage,
            fmt::format("--view '{}': expected AZIMUTH,ELEVATION in degrees, such as 30,20; "
                        "the elevation is -90 to 90",
                        text));
    }
    return view;
}

ViewAngles default_view(const Box3& box, UpAxis up_axis) {
    const Vec3 size = box.size();
    const double depth = up_axis == UpAxis::Z ? size.x : size.z;
    const double width = up_axis == UpAxis::Z ? size.y : size.x;
    const double height = up_axis == UpAxis::Z ? size.z : size.y;
    if (depth < kFlat * std::min(width, height)) return {0, 0};
    return {};
}

PerspectiveCamera framing_camera(const Box3& box, UpAxis up_axis, const ViewAngles& view,
                                 double aspect, const FarthestPoint& farthest) {
    const ViewFrame frame = view_frame(up_axis, view);
    Cloud cloud(box, frame);
    for (const Vec3& side : {frame.to_eye, frame.right, -frame.right, frame.up, -frame.up}) {
        (void)cloud.add_farthest(side, farthest);
    }
    // The rays found nothing: the corners of the box replace the parts.
    if (cloud.across().empty()) {
        for (int i = 0; i < 8; ++i) cloud.add(box.corner(i));
    }
    constexpr int kMostSteps = 64;
    EyePlace eye = place_eye(cloud, aspect);
    for (int step = 0; step < kMostSteps; ++step) {
        bool more = false;
        for (const double sign : {1.0, -1.0}) {
            more |= cloud.add_farthest(sign * frame.right + eye.across * frame.to_eye, farthest);
            more |= cloud.add_farthest(sign * frame.up + eye.along * frame.to_eye, farthest);
        }
        if (!more) break;
        eye = place_eye(cloud, aspect);
    }
    const Vec3 place =
        cloud.center() +
        cloud.unit() * (eye.back * frame.to_eye + eye.aside * frame.right + eye.above * frame.up);
    return look_along(place, -frame.to_eye, frame.up, kFieldOfView, aspect);
}

PerspectiveCamera framing_camera(const Box3& box, UpAxis up_axis, const ViewAngles& view,
                                 double aspect) {
    return framing_camera(box, up_axis, view, aspect,
                          [&](const Vec3& direction, double least) -> std::optional<Vec3> {
                              std::optional<Vec3> best;
                              for (int i = 0; i < 8; ++i) {
                                  if (!(dot(direction, box.corner(i)) > least)) continue;
                                  best = box.corner(i);
                                  least = dot(direction, *best);
                              }
                              return best;
                          });
}

bool glows(const Scene& scene, double radiance) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [&](const Material& m) { return m.emission.color.max() > radiance; });
}

bool lacks_light(const SceneDescription& description, const Scene& scene) {
    return scene.lights.empty() && description.conventions.importing.headlight &&
           !shows_without_light(scene);
}

Light headlight(const Camera& camera) {
    const auto at = [](const Vec3& eye) -> Light {
        return PointLight{
            .position = eye, .color = kHeadlight, .ambient = kHeadlightAmbient, .glints = false};
    };
    return std::visit(Overloaded{[&](const PerspectiveCamera& c) { return at(c.eye); },
                                 [&](const WideCamera& c) { return at(c.eye); },
                                 [](const OrthographicCamera& c) -> Light {
                                     return DirectionalLight{.to_light = normalize(-c.direction),
                                                             .color = kHeadlight,
                                                             .ambient = kHeadlightAmbient,
                                                             .glints = false};
                                 }},
                      camera);
}

std::vector<std::string> complete_view(SceneDescription& description, Scene& scene,
                                       const FramingOptions& options) {
    std::vector<std::string> notes;
    if (options.view || scene.cameras.empty()) {
        const bool had_none = scene.cameras.empty();
        ViewAngles view;
        const CameraDescription camera = framed_camera(scene, description.up_axis, options, view);
        description.cameras.insert(description.cameras.begin(), camera);
        scene.cameras.insert(scene.cameras.begin(), camera);
        if (had_none && !options.view) {
            notes.push_back(
                fmt::format("no camera in the file: framed from azimuth {}, elevation {}",
                            view.azimuth_deg, view.elevation_deg));
        }
    }
    if (options.nothing_around) return notes;
    if (options.follows_light && (scene.environment || glows(scene))) return notes;
    if (options.follows_light && lacks_light(description, scene) && !scene.background.is_black()) {
        notes.push_back("no lights in the file: its background lights it (--environment)");
    } else if (lacks_light(description, scene)) {
        const Light light = headlight(find_camera(scene, options.camera).camera);
        description.lights.push_back({"headlight", light, {}});
        scene.lights.push_back(light);
        if (!description.picture.background) {
            description.picture.background = kHeadlightBackground;
            scene.background = kHeadlightBackground;
        }
        notes.push_back("no lights in the file: a headlight was added");
    } else if (!scene.lights.empty() && description.conventions.importing.surroundings &&
               !description.picture.background) {
        const Light light = AmbientLight{kSurroundings};
        description.lights.push_back({"surroundings", light, {}});
        scene.lights.push_back(light);
        description.picture.background = kSurroundings;
        scene.background = kSurroundings;
        notes.push_back("no surroundings in the file: dim grey ones were added");
    }
    return notes;
}

}  // namespace alhazen
