// Readers of cameras and lights.
#include <numbers>
#include <utility>

#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

void read_perspective(const JsonObject& object, Camera& camera) {
    object.require("yfov");
    object.require("znear");
    camera.aspect = object.number("aspectRatio", kPositive);
    camera.yfov = object.number("yfov", kPositive).value_or(1);
    if (camera.yfov >= std::numbers::pi) {
        constexpr double kWidest = 3.0;  // 172 degrees
        object.warning("yfov", "expected an angle below pi; taken as " + written(kWidest));
        camera.yfov = kWidest;
    }
    camera.near = object.number("znear", kPositive).value_or(1);
    camera.far = object.number("zfar", kPositive);
    if (camera.far && *camera.far <= camera.near) {
        object.error("zfar", "expected a distance beyond znear");
    }
}

void read_orthographic(const JsonObject& object, Camera& camera) {
    for (const char* key : {"xmag", "ymag", "znear", "zfar"}) object.require(key);
    camera.xmag = object.number("xmag").value_or(1);
    camera.ymag = object.number("ymag").value_or(1);
    for (auto [key, value] : {std::pair{"xmag", &camera.xmag}, std::pair{"ymag", &camera.ymag}}) {
        if (*value == 0) object.error(key, "must not be 0");
    }
    camera.near = object.number("znear", kNotNegative).value_or(0);
    camera.far = object.number("zfar", kPositive);
    if (camera.far && *camera.far <= camera.near) {
        object.error("zfar", "expected a distance beyond znear");
    }
}

Camera read_camera(const JsonObject& object) {
    Camera camera;
    camera.name = object.text("name").value_or("");
    object.require("type");
    const std::string type = object.text("type").value_or("perspective");
    if (type != "perspective" && type != "orthographic") {
        object.warning("type", "expected perspective or orthographic; taken as perspective");
        return camera;
    }
    if (object.has("perspective") && object.has("orthographic")) {
        object.error({}, "expected one of \"perspective\" and \"orthographic\"");
    }
    camera.perspective = type == "perspective";
    object.require(type);
    object.with_object(type, [&](const JsonObject& lens) {
        camera.perspective ? read_perspective(lens, camera) : read_orthographic(lens, camera);
    });
    return camera;
}

void read_spot(const JsonObject& object, PunctualLight& light) {
    object.number_into("innerConeAngle", light.inner_cone, {0, std::numbers::pi / 2});
    object.number_into("outerConeAngle", light.outer_cone, {0, std::numbers::pi / 2 + 1e-6});
    if (light.inner_cone >= light.outer_cone) {
        object.error("outerConeAngle", "expected an angle above innerConeAngle");
    }
}

PunctualLight read_light(const JsonObject& object) {
    PunctualLight light;
    light.name = object.text("name").value_or("");
    object.require("type");
    const std::string type = object.text("type").value_or("point");
    if (type == "directional") {
        light.type = PunctualLight::Type::Directional;
    } else if (type == "spot") {
        light.type = PunctualLight::Type::Spot;
    } else if (type != "point") {
        object.warning("type", "expected directional, point or spot; taken as point");
    }
    object.numbers_into("color", light.color, kUnitRange);
    object.number_into("intensity", light.intensity, kNotNegative);
    light.range = object.number("range", kPositive);
    if (light.type == PunctualLight::Type::Spot) {
        object.require("spot");
        object.with_object("spot", [&](const JsonObject& spot) { read_spot(spot, light); });
    }
    return light;
}

}  // namespace

void read_cameras(const JsonObject& root, Loading& loading) {
    root.each_object("cameras", [&](const JsonObject& object, std::size_t) {
        loading.document.cameras.push_back(read_camera(object));
    });
}

void read_lights(const JsonObject& root, Loading& loading) {
    root.with_extension("KHR_lights_punctual", [&](const JsonObject& extension) {
        extension.require("lights");
        extension.each_object("lights", [&](const JsonObject& object, std::size_t) {
            loading.document.lights.push_back(read_light(object));
        });
    });
}

}  // namespace alhazen::gltf
