#include "alhazen/formats/native/read/native_cameras.h"

#include <string>
#include <utility>
#include <vector>

#include "alhazen/formats/native/native_words.h"
#include "alhazen/formats/native/read/native_transform.h"
#include "alhazen/formats/native/read/native_view_fields.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

struct View {
    Vec3 eye, look{0, 0, -1}, up{0, 1, 0};
    double aspect = 1;
};

View read_view(BlockReader& reader, NativeContext& context) {
    View view;
    reader.require("eye");
    reader.read("eye", view.eye);
    if (const auto look = read_direction(reader, view.eye, "look_at", "direction")) {
        view.look = *look;
    }
    reader.read("up", view.up);
    const Vec3 side = cross(normalize(view.look), view.up);
    if (!(length_squared(side) > 0)) {
        reader.error(reader.block(), "'up' must not be zero or along the view");
        view.up = perpendicular(normalize(view.look));
    }
    if (!read_positive(reader, "aspect", view.aspect)) {
        context.cameras_without_aspect.push_back(context.scene.cameras.size());
    }
    return view;
}

void add_camera(const NativeBlock& block, NativeContext& context, const Camera& camera,
                double aspect, std::vector<TransformKey> keys) {
    context.scene.cameras.push_back({block.name, camera, aspect, block.location, std::move(keys)});
}

/// Reads the lens of a camera: a radius above 0 makes one; `focus_at` is a point in the plane of
/// focus.
void read_lens(BlockReader& reader, PerspectiveCamera& camera) {
    const bool has_lens = reader.read("lens_radius", camera.lens.radius);
    Vec3 at;
    reader.read("blades", camera.lens.blades);
    read_angle(reader, "blade_turn_deg", "blade_turn_rad", camera.lens.turn);
    reader.read("focus_distance", camera.lens.focus_distance);
    const bool has_point = reader.read("focus_at", at);
    if (has_point) {
        Vec3 forward = normalize(cross(camera.up, camera.right));
        if (dot(forward, camera.look) < 0) forward = -forward;
        const double distance = dot(at - camera.eye, forward);
        if (distance > 0) {
            camera.lens.focus_distance = distance;
        } else {
            reader.error(*reader.find("focus_at"),
                         "'focus_at' must be in front of the camera, not beside or behind it");
        }
    }
    if (has_point && reader.has("focus_distance")) {
        reader.error(reader.block(),
                     "'focus_at' and 'focus_distance' exclude each other; expected one "
                     "of them");
    }
    if (has_lens && camera.lens.radius > 0 && !has_point && !reader.has("focus_distance")) {
        reader.error(reader.block(),
                     "a lens needs 'focus_distance = ...' or 'focus_at = (x, y, z)'");
    }
}

void read_perspective_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    const View view = read_view(reader, context);
    double fov_deg = 45;
    if (reader.read("fov_deg", fov_deg) && !(fov_deg > 0 && fov_deg < 180)) {
        reader.error(reader.block(), "'fov_deg' must be between 0 and 180");
        fov_deg = 45;
    }
    PerspectiveCamera camera =
        look_along(view.eye, view.look, view.up, fov_deg * kRadiansPerDegree, view.aspect);
    read_lens(reader, camera);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context, camera, view.aspect, std::move(keys));
}

void read_sheared_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    PerspectiveCamera camera;
    double aspect = 1;
    for (const char* key : {"eye", "look", "right", "up", "aspect"}) reader.require(key);
    reader.read("eye", camera.eye);
    reader.read("look", camera.look);
    reader.read("right", camera.right);
    reader.read("up", camera.up);
    read_positive(reader, "aspect", aspect);
    read_lens(reader, camera);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context, camera, aspect, std::move(keys));
}

void read_sheared_orthographic_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    OrthographicCamera camera;
    double aspect = 1;
    for (const char* key : {"eye", "direction", "right", "up", "aspect"}) reader.require(key);
    reader.read("eye", camera.origin);
    reader.read("direction", camera.direction);
    reader.read("right", camera.right);
    reader.read("up", camera.up);
    read_positive(reader, "aspect", aspect);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context, camera, aspect, std::move(keys));
}

void read_orthographic_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    const View view = read_view(reader, context);
    double height = 1;
    reader.require("height");
    read_positive(reader, "height", height);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context,
               look_along_parallel(view.eye, view.look, view.up, height, view.aspect), view.aspect,
               std::move(keys));
}

void read_fisheye_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    const View view = read_view(reader, context);
    double fov_deg = 180;
    if (reader.read("fov_deg", fov_deg) && !(fov_deg > 0 && fov_deg <= 360)) {
        reader.error(reader.block(), "'fov_deg' must be above 0 and at most 360");
        fov_deg = 180;
    }
    WideProjection projection = WideProjection::Equidistant;
    reader.read_word("projection", native_words<WideProjection>(), projection);
    if (projection == WideProjection::Panorama) {
        reader.error(*reader.find("projection"),
                     "'projection' of a fisheye must be equidistant or equisolid; for the other "
                     "there is 'panorama_camera'");
        projection = WideProjection::Equidistant;
    }
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context,
               look_around(view.eye, view.look, view.up, projection, fov_deg * kRadiansPerDegree,
                           view.aspect),
               view.aspect, std::move(keys));
}

/// Reads a panorama, whose aspect ratio is that of its angles.
void read_panorama_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    const std::size_t without = context.cameras_without_aspect.size();
    View view = read_view(reader, context);
    double width_deg = 360, height_deg = 180;
    const auto read_degrees = [&](const char* key, double most, double& degrees) {
        if (reader.read(key, degrees) && !(degrees > 0 && degrees <= most)) {
            reader.error(*reader.find(key), "'" + std::string(key) +
                                                "' must be above 0 and at most " +
                                                std::to_string(static_cast<int>(most)));
            degrees = most;
        }
    };
    read_degrees("width_deg", 360, width_deg);
    read_degrees("height_deg", 180, height_deg);
    const double ratio = width_deg / height_deg;
    if (context.cameras_without_aspect.size() > without) {
        context.cameras_without_aspect.pop_back();
        view.aspect = ratio;
    }
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context,
               look_around(view.eye, view.look, view.up, WideProjection::Panorama,
                           height_deg * kRadiansPerDegree, ratio),
               view.aspect, std::move(keys));
}

void read_wide_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    WideCamera camera;
    double aspect = 1;
    for (const char* key :
         {"eye", "look", "right", "up", "projection", "width_rad", "height_rad", "aspect"}) {
        reader.require(key);
    }
    reader.read("eye", camera.eye);
    reader.read("look", camera.look);
    reader.read("right", camera.right);
    reader.read("up", camera.up);
    reader.read_word("projection", native_words<WideProjection>(), camera.projection);
    read_positive(reader, "width_rad", camera.width);
    read_positive(reader, "height_rad", camera.height);
    read_positive(reader, "aspect", aspect);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context, camera, aspect, std::move(keys));
}

// ADD A CAMERA HERE: the blocks that make it. An alternative of `Camera` without an overload does
// not compile.

std::vector<NativeTopBlock> blocks_of(std::type_identity<PerspectiveCamera>) {
    return {{"perspective_camera", read_perspective_camera},
            {"sheared_camera", read_sheared_camera}};
}
std::vector<NativeTopBlock> blocks_of(std::type_identity<OrthographicCamera>) {
    return {{"orthographic_camera", read_orthographic_camera},
            {"sheared_orthographic_camera", read_sheared_orthographic_camera}};
}
std::vector<NativeTopBlock> blocks_of(std::type_identity<WideCamera>) {
    return {{"fisheye_camera", read_fisheye_camera},
            {"panorama_camera", read_panorama_camera},
            {"wide_camera", read_wide_camera}};
}

}  // namespace

std::span<const NativeTopBlock> native_camera_blocks() {
    static const std::vector<NativeTopBlock> kBlocks = blocks_of_all(
        std::type_identity<Camera>{}, [](auto alternative) { return blocks_of(alternative); });
    return kBlocks;
}

void complete_cameras(NativeContext& context) {
    const PictureSettings& picture = context.scene.picture;
    if (!picture.width || !picture.height) return;
    const double aspect = static_cast<double>(*picture.width) / *picture.height;
    for (const std::size_t i : context.cameras_without_aspect) {
        CameraDescription& camera = context.scene.cameras[i];
        camera.camera = with_aspect(camera.camera, camera.aspect, aspect);
        camera.aspect = aspect;
    }
}

}  // namespace alhazen
