#include "alhazen/formats/uw_yaml/uw_yaml_scene.h"

#include <array>

#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

/// Limit on nodes and components read: aliases can expand a short text enormously.
constexpr std::size_t kMaxVisits = 200'000;
/// Half the thickness of the format's plane, which has two sheets. Light that crosses both within
/// the format's minimum distance meets one.
constexpr double kPlaneHalfThickness = 1e-5;

/// Keys of which some have no effect on a trace.
constexpr std::array<std::string_view, 9> kSceneKeys{
    "Name",   "Animation Length", "Animation FPS",  "Textures", "Cubemaps",
    "Meshes", "Materials",        "ShaderPrograms", "Root"};
constexpr std::array<std::string_view, 9> kCameraKeys{"FOV",
                                                      "Near Plane",
                                                      "Far Plane",
                                                      "Perspective Camera?",
                                                      "Orthographic View Width",
                                                      "Render Width (px)",
                                                      "Render Height (px)",
                                                      "Trace",
                                                      "Trace Debugger"};
constexpr std::array<std::string_view, 18> kTraceKeys{"Maximum Recursion Depth",
                                                      "Shadows",
                                                      "Enable Shadows",
                                                      "Reflections",
                                                      "Refractions",
                                                      "Monte Carlo",
                                                      "Samples Per Pixel",
                                                      "Aperture Size",
                                                      "Focus Distance",
                                                      "Caustics",
                                                      "Diffuse Reflection",
                                                      "Difference Threshold",
                                                      "Enable BVH Acceleration",
                                                      "Maximum Samples",
                                                      "Minimum Samples",
                                                      "Random Single Branching",
                                                      "Sample Count Type",
                                                      "Std. Error Threshold"};
constexpr std::array<std::string_view, 5> kTraceDebuggerKeys{
    "Show Diffuse Reflection Rays", "Show Reflection Rays", "Show Refraction Rays",
    "Show Shadow Rays", "Show Surface Normals"};

double radians(double degrees) {
    return degrees * kRadiansPerDegree;
}

}  // namespace

UwSceneReader::UwSceneReader(const YAML::Node& document, const ImportSource& source,
                             SceneDescription& scene, Diagnostics& diagnostics)
    : document_(document),
      source_(source),
      scene_(scene),
      values_(source.path.string(), diagnostics),
      assets_(document, source, scene, diagnostics) {}

void UwSceneReader::read() {
    scene_.objects.emplace_back();
    values_.check_keys(document_, "the scene", kSceneKeys);
    values_.check_keys(YamlValues::find(document_, "Cubemaps"), "Cubemaps");
    scene_.objects[0].name = values_.text(document_, "Name");
    const YAML::Node root = YamlValues::find(document_, "Root");
    if (!root.IsDefined() || !root.IsMap()) {
        values_.error(root.IsDefined() ? root : document_, "the scene has no map 'Root'");
        return;
    }
    read_node(root, Affine{}, 0);
    // Later stages require at least one material.
    if (scene_.materials.empty()) scene_.materials.emplace_back();
}

void UwSceneReader::count_visit(const YAML::Node& node) {
    if (++visits_ <= kMaxVisits) return;
    throw Error(ErrorKind::Resource,
                "more than " + std::to_string(kMaxVisits) + " nodes and components",
                values_.location(node));
}

void UwSceneReader::read_node(const YAML::Node& node, const Affine& world_from_parent, int depth) {
    count_visit(node);
    if (depth > source_.options.max_nesting) {
        throw Error(
            ErrorKind::Resource,
            "nodes nested more than " + std::to_string(source_.options.max_nesting) + " deep",
            values_.location(node));
    }
    if (!node.IsMap()) return values_.error(node, "a node must be a map with Name and Components");
    if (!values_.flag(node, "Enabled", true)) return;
    values_.check_keys(node, "a node", {"Name", "Enabled", "Components", "Children"});
    const YAML::Node components = YamlValues::find(node, "Components");
    values_.check_keys(components, "Components", {}, "both count, except of Transform the first");
    const YAML::Node transform = YamlValues::find(components, "Transform");
    values_.check_keys(transform, "Transform", {"Translation", "Rotation", "Scale"});
    const Vec3 angles = values_.vector(transform, "Rotation", 0.0);
    const Affine parent_from_node =
        Affine::translate(values_.vector(transform, "Translation", 0.0)) *
        Affine::rotate({1, 0, 0}, radians(angles.x)) *
        Affine::rotate({0, 1, 0}, radians(angles.y)) *
        Affine::rotate({0, 0, 1}, radians(angles.z)) *
        Affine::scale(values_.vector(transform, "Scale", 1.0));
    const Place place{values_.text(node, "Name"), world_from_parent * parent_from_node,
                      values_.location(node)};
    if (components.IsDefined() && components.IsMap()) {
        for (const auto& entry : components) {
            if (!entry.first.IsScalar()) continue;
            count_visit(entry.second);
            const std::string& name = entry.first.Scalar();
            if (const ReadComponent reader = reader_of(name)) {
                (this->*reader)(place, entry.second);
            } else {
                warn_once(entry.first, name, "the component '" + name + "' is not known; ignored");
            }
        }
    }
    const YAML::Node children = YamlValues::find(node, "Children");
    if (!children.IsDefined() || children.IsNull()) return;
    if (!children.IsSequence()) return values_.error(children, "'Children' must be a list");
    for (const auto& child : children) read_node(child, place.world_from_node, depth + 1);
}

UwSceneReader::ReadComponent UwSceneReader::reader_of(const std::string& component) {
    static const std::array<std::pair<std::string_view, ReadComponent>, 14> kComponentReaders{{
        {"Transform", &UwSceneReader::nothing},  // read before all others
        {"EnvironmentMap", &UwSceneReader::environment_map},
        {"Sphere", &UwSceneReader::sphere},
        {"Cylinder", &UwSceneReader::cylinder},
        {"Cone", &UwSceneReader::cone},
        {"Plane", &UwSceneReader::plane},
        {"Ring", &UwSceneReader::ring},
        {"TriangleMesh", &UwSceneReader::triangle_mesh},
        {"SurfaceOfRevolution", &UwSceneReader::surface_of_revolution},
        {"ParticleSystem", &UwSceneReader::particle_system},
        {"PointLight", &UwSceneReader::point_light},
        {"DirectionalLight", &UwSceneReader::directional_light},
        {"AreaLight", &UwSceneReader::area_light},
        {"Camera", &UwSceneReader::camera},
    }};
    for (const auto& [name, read] : kComponentReaders) {
        if (name == component) return read;
    }
    return nullptr;
}

void UwSceneReader::environment_map(const Place&, const YAML::Node& component) {
    // For the rasteriser of the course.
    values_.check_keys(component, "EnvironmentMap",
                       {"Near Plane", "Far Plane", "Render Material", "Resolution (px)"});
}

void UwSceneReader::add_part(const Place& place, const YAML::Node& component,
                             std::variant<AnyShape, MeshIndex, ObjectIndex> what,
                             const Affine& node_from_part) {
    const MaterialId material = assets_.material(component);
    const Affine world_from_part = place.world_from_node * node_from_part;
    if (!is_invertible(world_from_part)) {
        // An object scaled to zero, as in animations, is invisible.
        return values_.warning(component, "'" + place.name + "' has scale 0 and is not drawn");
    }
    scene_.objects[0].parts.push_back(
        {std::move(what), world_from_part, material, place.name, place.location});
}

void UwSceneReader::sphere(const Place& place, const YAML::Node& component) {
    values_.check_keys(component, "Sphere", {"Material", "Quality", "Roundness"});
    Sphere sphere;
    sphere.radius = 0.5;
    // Poles lie on z in this library, on y in the format. As in the spheres that the course's
    // program exports, u = 0 lies on -z, u = 1/4 on -x, and v runs from the top downwards.
    const Affine poles_on_y{{{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}, {}};
    add_part(place, component, sphere, poles_on_y);
}

void UwSceneReader::cylinder(const Place& place, const YAML::Node& component) {
    values_.check_keys(component, "Cylinder", {"Material", "Subdivisions"});
    Cylinder cylinder;
    cylinder.base = {0, -0.5, 0};
    cylinder.top = {0, 0.5, 0};
    cylinder.radius = 0.5;
    add_part(place, component, cylinder);
}

void UwSceneReader::cone(const Place& place, const YAML::Node& component) {
    values_.check_keys(component, "Cone", {"Material", "Subdivisions"});
    Cone cone;
    cone.base = {0, -0.5, 0};
    cone.top = {0, 0.5, 0};
    cone.base_radius = 0.5;
    add_part(place, component, cone);
}

void UwSceneReader::plane(const Place& place, const YAML::Node& component) {
    values_.check_keys(component, "Plane", {"Material", "Subdivisions"});
    Rectangle front;
    front.corner = {-0.5, -0.5, kPlaneHalfThickness};
    Rectangle back;
    back.corner = {0.5, -0.5, -kPlaneHalfThickness};
    back.edge_u = {-1, 0, 0};
    add_part(place, component, front);
    add_part(place, component, back);
}

void UwSceneReader::ring(const Place& place, const YAML::Node& component) {
    values_.check_keys(component, "Ring", {"Material", "Width", "Subdivisions"});
    const double width = values_.number(component, "Width", 0.5);
    if (!(width > 0.0)) return values_.error(component, "the Width of a Ring must be positive");
    Disc disc;
    disc.radius = 0.5;
    disc.inner_radius = std::max(0.0, 0.5 - width);
    warn_once(component, "Ring", "a Ring is drawn in the xy plane, outer radius 0.5: not verified");
    add_part(place, component, disc);
}

void UwSceneReader::triangle_mesh(const Place& place, const YAML::Node& component) {
    values_.check_keys(component, "TriangleMesh", {"Mesh", "Material", "LoopSubdivision"});
    const std::string name = values_.text(component, "Mesh");
    if (values_.number(component, "LoopSubdivision", 0.0) > 0.0) {
        values_.warning(component, "'LoopSubdivision' of '" + place.name + "' is ignored");
    }
    if (name == "Cube" && !assets_.has_mesh(name)) {
        // Without a texture, the texture coordinates in which a box differs do not matter.
        if (!assets_.is_textured(assets_.material(component))) {
            return add_part(place, component, BoxShape{});
        }
        return add_part(place, component, assets_.textured_cube(component));
    }
    if (name.empty()) {
        return values_.warning(component, "'" + place.name + "' names no mesh and is not drawn");
    }
    if (const std::optional<MeshIndex> mesh = assets_.mesh(name, component)) {
        add_part(place, component, *mesh);
    }
}

void UwSceneReader::surface_of_revolution(const Place& place, const YAML::Node& component) {
    values_.warning(component,
                    "SurfaceOfRevolution '" + place.name + "' is not supported and not drawn");
}

void UwSceneReader::particle_system(const Place& place, const YAML::Node& component) {
    values_.warning(component, "ParticleSystem '" + place.name +
                                   "' is not drawn: it has particles only while it is animated");
}

void UwSceneReader::point_light(const Place& place, const YAML::Node& component) {
    values_.check_keys(
        component, "light",
        {"Color", "Ambient", "Const Atten", "Linear Atten", "Quad Atten", "Radius (Trace)"});
    PointLight light;
    light.position = place.world_from_node.translation;
    light.color = values_.color(component, "Color");
    light.ambient = values_.color(component, "Ambient");
    light.attenuation.constant = values_.number(component, "Const Atten", 1.0);
    light.attenuation.linear = values_.number(component, "Linear Atten", 0.0);
    light.attenuation.quadratic = values_.number(component, "Quad Atten", 0.0);
    if (values_.number(component, "Radius (Trace)", 0.0) > 0.0) {
        values_.warning(component, "the radius of '" + place.name + "' is ignored: it is a point");
    }
    scene_.lights.push_back({place.name, light, place.location});
}

void UwSceneReader::area_light(const Place& place, const YAML::Node& component) {
    values_.warning(component, "AreaLight '" + place.name + "' is taken as a point at its centre");
    point_light(place, component);
}

void UwSceneReader::directional_light(const Place& place, const YAML::Node& component) {
    values_.check_keys(component, "DirectionalLight",
                       {"Color", "Ambient", "Intensity Multiplier", "Angular Size (Trace)"});
    const Vec3 to_light = place.world_from_node.vector({0, 1, 0});
    if (!(length_squared(to_light) > 0.0) || !is_finite(to_light)) {
        return values_.error(component, "the transform of '" + place.name + "' has no y direction");
    }
    DirectionalLight light;
    light.to_light = normalize(to_light);
    light.color =
        values_.number(component, "Intensity Multiplier", 1.0) * values_.color(component, "Color");
    light.ambient = values_.color(component, "Ambient");
    if (values_.number(component, "Angular Size (Trace)", 0.0) > 0.0) {
        values_.warning(component, "the angular size of '" + place.name + "' is ignored");
    }
    scene_.lights.push_back({place.name, light, place.location});
}

void UwSceneReader::camera(const Place& place, const YAML::Node& component) {
    values_.check_keys(component, "Camera", kCameraKeys);
    values_.check_keys(YamlValues::find(component, "Trace Debugger"), "Trace Debugger",
                       kTraceDebuggerKeys);
    const double fov = values_.number(component, "FOV", 50.0);
    const double width = values_.number(component, "Render Width (px)", 512.0);
    const double height = values_.number(component, "Render Height (px)", 512.0);
    if (!(width >= 1.0 && height >= 1.0 && width <= 65536.0 && height <= 65536.0)) {
        return values_.error(component, "the picture must be 1 to 65536 pixels a side");
    }
    if (!(fov > 0.0 && fov < 180.0)) {
        return values_.error(component, "the FOV must be in (0, 180) degrees");
    }
    const Vec3 eye = place.world_from_node.translation;
    const Vec3 look = place.world_from_node.vector({0, 0, -1});
    const Vec3 up = place.world_from_node.vector({0, 1, 0});
    if (!(length_squared(look) > 0.0) || !is_finite(look) || !is_finite(up) || !is_finite(eye)) {
        return values_.error(component,
                             "the transform of '" + place.name + "' has no view direction");
    }
    const double aspect = width / height;
    Camera camera = look_along(eye, look, up, radians(fov), aspect);
    if (!values_.flag(component, "Perspective Camera?", true)) {
        const double view_width = values_.number(component, "Orthographic View Width", 5.0);
        if (!(view_width > 0.0)) {
            return values_.error(component, "the Orthographic View Width must be positive");
        }
        camera = look_along_parallel(eye, look, up, view_width / aspect, aspect);
    }
    if (scene_.cameras.empty()) {
        scene_.picture.width = int(width);
        scene_.picture.height = int(height);
        trace_settings(YamlValues::find(component, "Trace"));
    }
    scene_.cameras.push_back({place.name, camera, aspect, place.location});
}

void UwSceneReader::trace_settings(const YAML::Node& trace) {
    values_.check_keys(trace, "Trace", kTraceKeys);
    ShadingConventions& shading = scene_.conventions.shading;
    const double depth = values_.number(trace, "Maximum Recursion Depth", shading.max_depth);
    if (depth >= 0.0 && depth <= 1000.0) {
        shading.max_depth = int(depth);
    } else {
        values_.error(trace, "the Maximum Recursion Depth must be 0 to 1000");
    }
    shading.trace_reflections = values_.flag(trace, "Reflections", true);
    shading.trace_refractions = values_.flag(trace, "Refractions", true);
    shadow_settings(trace);
    for (const char* setting : {"Monte Carlo", "Samples Per Pixel", "Aperture Size"}) {
        if (values_.number(trace, setting, 0.0) > 0.0) {
            values_.warning(trace,
                            std::string("'") + setting +
                                "' is ignored: one ray through each pixel's centre is traced");
        }
    }
}

/// Reads `Shadows`: 0 (none), 1 (all surfaces opaque) or 2 (coloured); older files have the switch
/// `Enable Shadows`.
void UwSceneReader::shadow_settings(const YAML::Node& trace) {
    using ShadowTint = ShadingConventions::ShadowTint;
    ShadowTint& tint = scene_.conventions.shading.shadow_tint;
    if (!values_.flag(trace, "Enable Shadows", true)) tint = ShadowTint::None;
    const YAML::Node shadows = YamlValues::find(trace, "Shadows");
    if (!shadows.IsDefined() || shadows.IsNull()) return;
    const std::optional<double> level = YamlValues::number_of(shadows);
    const std::optional<bool> flag = YamlValues::flag_of(shadows);
    if (level == 2.0 || flag == true) return;
    if (level == 0.0 || flag == false) {
        tint = ShadowTint::None;
    } else if (level == 1.0) {
        tint = ShadowTint::Opaque;
    } else {
        values_.error(shadows, "Shadows must be 0 (none), 1 (opaque) or 2 (coloured)");
    }
}

void UwSceneReader::warn_once(const YAML::Node& node, const std::string& what,
                              const std::string& message) {
    if (warned_.size() < 100 && warned_.insert(what).second) values_.warning(node, message);
}

}  // namespace alhazen
