#include "alhazen/session/framing.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "alhazen/base/error.h"
#include "alhazen/base/overloaded.h"
#include "alhazen/math/constants.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

namespace {

constexpr double kFieldOfView = kPi / 4;
constexpr double kMargin = 0.05;
/// Boxes flatter than this fraction of their other sides are viewed from the front.
constexpr double kFlat = 0.25;
constexpr Rgb kHeadlight{0.75, 0.75, 0.75};
constexpr Rgb kHeadlightAmbient{0.25, 0.25, 0.25};
constexpr Rgb kHeadlightBackground{0.3, 0.3, 0.3};

struct Turn {
    double cosine, sine;
};

/// Exact at quarter turns, so that a view along an axis is exact.
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

/// Unit vectors of a view: from the scene to the eye, to the right and up in the image.
struct ViewFrame {
    Vec3 to_eye, right, up;
};

ViewFrame view_frame(UpAxis up_axis, const ViewAngles& view) {
    const Turn a = turn(view.azimuth_deg);
    const Turn e = turn(view.elevation_deg);
    // In (front, side, height); `up` is the derivative of `to_eye` by elevation, which is also
    // defined at the poles.
    const auto place = [&](double front, double side, double height) {
        return up_axis == UpAxis::Z ? Vec3{front, side, height} : Vec3{side, height, front};
    };
    return {place(a.cosine * e.cosine, a.sine * e.cosine, e.sine), place(-a.sine, a.cosine, 0),
            place(-a.cosine * e.sine, -a.sine * e.sine, e.cosine)};
}

/// Distance of the eye at which the two sides of its pyramid, of half-width `tangent` at distance
/// 1, contain all points (across, towards the eye).
double least_distance(const std::array<Vec2, 8>& points, double tangent) {
    double right = -std::numeric_limits<double>::infinity();
    double left = right;
    for (const Vec2& p : points) {
        right = std::max(right, p.x + p.y * tangent);
        left = std::max(left, -p.x + p.y * tangent);
    }
    return (right + left) / (2.0 * tangent);
}

/// Lateral position of an eye at that distance at which the outermost points appear equally far
/// from the centre: their apparent offset to the right decreases as the eye moves right.
double centred_place(const std::array<Vec2, 8>& points, double distance) {
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

class BoundedBoxes {
  public:
    Box3 of(const Aggregate& aggregate) {
        const Box3 whole = aggregate.box();
        if (whole.empty() || whole.bounded()) return whole;
        const auto known = boxes_.find(&aggregate);
        if (known != boxes_.end()) return known->second;
        const PrimitiveTable& table = aggregate.primitives();
        Box3 sum;
        for (std::size_t i = 0; i < table.size(); ++i) {
            Box3 box = table.box(i);
            if (!box.bounded() && i >= table.first(kInstanceKind)) {
                // Nesting is bounded: compile refuses more than kMaxInstanceDepth.
                const Instance& instance = table.instances[i - table.first(kInstanceKind)];
                box = transformed(instance.placement.outer_from_inner, of(*instance.aggregate));
            }
            if (!box.empty() && box.bounded()) sum.include(box);
        }
        return boxes_[&aggregate] = sum;
    }

  private:
    std::map<const Aggregate*, Box3> boxes_;
};

CameraDescription framed_camera(const Scene& scene, UpAxis up_axis, const FramingOptions& options,
                                ViewAngles& view) {
    const Box3 box = bounded_part(*scene.aggregate);
    if (box.empty()) {
        throw Error(ErrorKind::Scene,
                    scene.aggregate->box().empty()
                        ? "the scene has nothing that could be seen, and no camera"
                        : "the scene has no camera, and nothing of finite size to point one at");
    }
    if (!is_finite(box.size())) {
        throw Error(ErrorKind::Scene, "the scene has no camera and is too large to be framed");
    }
    view = options.view.value_or(default_view(box, up_axis));
    CameraDescription camera;
    camera.name = "framed";
    camera.camera = framing_camera(box, up_axis, view, options.aspect);
    camera.aspect = options.aspect;
    return camera;
}

/// A light at the eye: visible points are never in shadow.
Light headlight(const Camera& camera) {
    return std::visit(Overloaded{[](const PerspectiveCamera& c) -> Light {
                                     return PointLight{.position = c.eye,
                                                       .color = kHeadlight,
                                                       .ambient = kHeadlightAmbient};
                                 },
                                 [](const OrthographicCamera& c) -> Light {
                                     return DirectionalLight{.to_light = normalize(-c.direction),
                                                             .color = kHeadlight,
                                                             .ambient = kHeadlightAmbient};
                                 }},
                      camera);
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

Box3 bounded_part(const Aggregate& aggregate) {
    return BoundedBoxes().of(aggregate);
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
                                 double aspect) {
    const ViewFrame frame = view_frame(up_axis, view);
    const Vec3 center = box.center();
    // In units of the scene's size, so that products of lengths neither overflow nor underflow.
    const double reach = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
    double unit = largest_side(box.size());
    if (!(unit > 1e-12 * reach)) unit = reach > 0.0 ? 1e-6 * reach : 1.0;
    std::array<Vec2, 8> across{}, along{};
    for (int i = 0; i < 8; ++i) {
        const Vec3 p = (1.0 / unit) * (box.corner(i) - center);
        across[static_cast<std::size_t>(i)] = {dot(frame.right, p), dot(frame.to_eye, p)};
        along[static_cast<std::size_t>(i)] = {dot(frame.up, p), dot(frame.to_eye, p)};
    }
    const double tangent = (1.0 - 2.0 * kMargin) * std::tan(0.5 * kFieldOfView);
    double nearest = 0.0;
    for (const Vec2& p : across) nearest = std::max(nearest, p.y);
    // A box without width across the view would contain the eye.
    const double back = std::max(
        {least_distance(across, tangent * aspect), least_distance(along, tangent), nearest + 1e-3});
    const Vec3 eye =
        center + unit * (back * frame.to_eye + centred_place(across, back) * frame.right +
                         centred_place(along, back) * frame.up);
    return look_along(eye, -frame.to_eye, frame.up, kFieldOfView, aspect);
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
    if (scene.lights.empty() && description.conventions.importing.headlight &&
        !shows_without_light(scene)) {
        const Light light = headlight(find_camera(scene, options.camera).camera);
        description.lights.push_back({"headlight", light, {}});
        scene.lights.push_back(light);
        if (!description.picture.background) {
            description.picture.background = kHeadlightBackground;
            scene.background = kHeadlightBackground;
        }
        notes.push_back("no lights in the file: a headlight was added");
    }
    return notes;
}

}  // namespace alhazen
