#include "alhazen/formats/nff/nff_builder.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "alhazen/formats/mesh/bent_polygon.h"
#include "alhazen/formats/mesh/mesh_normals.h"
#include "alhazen/geometry/polygon/free_diagonals.h"
#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/geometry/polygon/triangulate.h"

namespace alhazen {

namespace {

/// True if some three of the vertices, the first among them, span an area.
bool has_area(const std::vector<Vec3>& vertices) {
    for (std::size_t i = 2; i < vertices.size(); ++i) {
        const Vec3 normal = cross(vertices[i - 1] - vertices[0], vertices[i] - vertices[0]);
        if (length_squared(normal) > 0.0) return true;
    }
    return false;
}

}  // namespace

NffBuilder::NffBuilder(SceneDescription& scene, const ImportOptions& options,
                       Diagnostics& diagnostics)
    : scene_(scene), options_(options), diagnostics_(diagnostics) {
    scene_.objects.emplace_back();
    scene_.objects[0].name = "scene";
}

void NffBuilder::set_fill(const NffFill& fill, const FileLocation& where) {
    const std::array<double, 12> key{fill.ambient.r,  fill.ambient.g,    fill.ambient.b,
                                     fill.diffuse.r,  fill.diffuse.g,    fill.diffuse.b,
                                     fill.specular.r, fill.specular.g,   fill.specular.b,
                                     fill.shininess,  fill.transmission, fill.index};
    const auto [entry, fresh] = materials_.try_emplace(key, MaterialId(scene_.materials.size()));
    material_ = entry->second;
    if (!fresh) return;
    Material material;
    material.name = "fill " + std::to_string(scene_.materials.size() + 1);
    material.ambient.color = fill.ambient;
    material.diffuse.color = fill.diffuse;
    material.specular.color = fill.specular;
    material.reflective.color = fill.specular;
    material.transmissive.color = grey(fill.transmission);
    material.shininess.value = fill.shininess;
    // Opaque materials conventionally have an index of 0.
    material.index.value = fill.index > 0.0 ? fill.index : 1.0;
    scene_.materials.push_back({std::move(material), where});
}

void NffBuilder::add_light(const Vec3& position, const std::optional<Rgb>& color,
                           const FileLocation& where) {
    PointLight light;
    light.position = position;
    if (color) light.color = *color;
    scene_.lights.push_back({"light " + std::to_string(scene_.lights.size() + 1), light, where});
    default_intensity_.push_back(!color);
}

MaterialId NffBuilder::current_material(const FileLocation& where) {
    if (!material_) {
        diagnostics_.warning(where, "an object before the first 'f'; it is white and diffuse");
        set_fill({{1, 1, 1}, {1, 1, 1}, {}, 0, 0, 1}, where);
    }
    return *material_;
}

void NffBuilder::check_room(const FileLocation& where) {
    if (++elements_ > options_.max_elements) {
        throw Error(ErrorKind::Resource,
                    "more than " + std::to_string(options_.max_elements) + " primitives", where);
    }
}

void NffBuilder::add_shape(AnyShape shape, const FileLocation& where) {
    check_room(where);
    const MaterialId material = current_material(where);
    Part& part = scene_.objects[0].parts.emplace_back();
    part.what = std::move(shape);
    part.material = material;
    part.location = where;
}

void NffBuilder::add_sphere(const Vec3& center, double radius, const FileLocation& where) {
    if (radius == 0.0) {
        ++degenerate_;
        return;
    }
    Sphere sphere;
    sphere.center = center;
    sphere.radius = std::abs(radius);
    add_shape(sphere, where);
}

void NffBuilder::add_cone(const Vec3& base, double base_radius, const Vec3& apex,
                          double apex_radius, const FileLocation& where) {
    if (base == apex || (base_radius == 0.0 && apex_radius == 0.0)) {
        ++degenerate_;
        return;
    }
    if (std::abs(base_radius) == std::abs(apex_radius)) {
        Cylinder cylinder;
        cylinder.base = base;
        cylinder.top = apex;
        cylinder.radius = std::abs(base_radius);
        cylinder.capped = false;
        return add_shape(cylinder, where);
    }
    Cone cone;
    cone.base = base;
    cone.top = apex;
    cone.base_radius = std::abs(base_radius);
    cone.top_radius = std::abs(apex_radius);
    cone.capped = false;
    add_shape(cone, where);
}

void NffBuilder::add_polygon(const std::vector<Vec3>& vertices, const std::vector<Vec3>& normals,
                             const FileLocation& where) {
    if (!has_area(vertices)) {
        ++degenerate_;
        return;
    }
    if (vertices.size() == 3 || !normals.empty()) return add_triangles(vertices, normals, where);
    const std::vector<std::uint32_t> loop_ends{std::uint32_t(vertices.size())};
    const Vec3 normal = plane_normal_of_loops(vertices, loop_ends);
    if (!(length_squared(normal) > 0.0) || edges_cancel(vertices, loop_ends)) {
        ++degenerate_;
        return;
    }
    Polygon polygon;
    polygon.vertices = vertices;
    polygon.loop_ends = loop_ends;
    if (const auto bent = bent_polygon(polygon)) {
        if (bent->is_simple) return add_triangles(vertices, normals, where);
        diagnostics_.warning(where, "polygon: " + bent->warning() + "met in their mean plane");
    }
    add_shape(std::move(polygon), where);
}

void NffBuilder::add_triangles(const std::vector<Vec3>& vertices, const std::vector<Vec3>& normals,
                               const FileLocation& where) {
    check_room(where);
    TriangleMesh& mesh = current_mesh(!normals.empty(), where);
    if (mesh.positions.size() + vertices.size() > 0xFFFFFFFFu) {
        throw Error(ErrorKind::Resource, "more than 2^32 vertices of one material", where);
    }
    std::vector<std::uint32_t> loop(vertices.size());
    std::iota(loop.begin(), loop.end(), std::uint32_t(mesh.positions.size()));
    mesh.positions.insert(mesh.positions.end(), vertices.begin(), vertices.end());
    mesh.normals.insert(mesh.normals.end(), normals.begin(), normals.end());
    const std::size_t first = mesh.triangles.size();
    triangulate(mesh.positions, loop, mesh.triangles);
    if (loop.size() > 3) polygons_[&mesh].push_back({first, mesh.triangles.size()});
}

TriangleMesh& NffBuilder::current_mesh(bool smooth, const FileLocation& where) {
    const MaterialId material = current_material(where);
    const auto [entry, fresh] = meshes_.try_emplace({material, smooth}, scene_.meshes.size());
    if (fresh) {
        const std::string name = std::string(smooth ? "patches " : "triangles ") +
                                 std::to_string(std::uint32_t(material) + 1);
        scene_.meshes.push_back({name, std::make_shared<TriangleMesh>(), where});
        scene_.objects[0].parts.push_back(
            {MeshIndex(entry->second), Affine{}, material, name, where});
    }
    return *scene_.meshes[entry->second].mesh;
}

void NffBuilder::add_camera(const NffView& view) {
    if (!view.from && !view.at && !view.up && !view.angle_deg && !view.resolution) return;
    const std::array<std::pair<const char*, bool>, 5> parts{
        {{"from", view.from.has_value()},
         {"at", view.at.has_value()},
         {"up", view.up.has_value()},
         {"angle", view.angle_deg.has_value()},
         {"resolution", view.resolution.has_value()}}};
    for (const auto& [name, present] : parts) {
        if (!present) {
            return diagnostics_.error(view.location,
                                      "the view has no line '" + std::string(name) + "'");
        }
    }
    const Vec3 look = *view.at - *view.from;
    if (!(length_squared(look) > 0.0)) {
        return diagnostics_.error(view.location, "'from' and 'at' of the view are the same point");
    }
    if (!(length_squared(cross(look, *view.up)) > 0.0)) {
        return diagnostics_.error(view.location,
                                  "'up' of the view must not be zero, nor along the view");
    }
    if (!(*view.angle_deg > 0.0 && *view.angle_deg < 180.0)) {
        return diagnostics_.error(view.location,
                                  "the angle of the view must be in (0, 180) degrees");
    }
    const double width = view.resolution->x;
    const double height = view.resolution->y;
    if (!(width >= 1.0 && height >= 1.0 && width <= 65536.0 && height <= 65536.0)) {
        return diagnostics_.error(view.location, "the resolution must be 1 to 65536 pixels a side");
    }
    if (width != std::floor(width) || height != std::floor(height)) {
        return diagnostics_.error(view.location, "the resolution must be two whole numbers");
    }
    scene_.picture.width = int(width);
    scene_.picture.height = int(height);
    const double aspect = width / height;
    const double fov = *view.angle_deg * std::numbers::pi / 180.0;
    scene_.cameras.push_back(
        {"view", look_along(*view.from, look, *view.up, fov, aspect), aspect, view.location});
}

void NffBuilder::finish(const NffView& view) {
    add_camera(view);
    const double n = double(default_intensity_.size());
    const Rgb intensity = grey(n == 0.0 ? 1.0 : std::sqrt(n) / (2.0 * n));
    for (std::size_t i = 0; i < default_intensity_.size(); ++i) {
        if (default_intensity_[i]) std::get<PointLight>(scene_.lights[i].light).color = intensity;
    }
    scene_.lights.push_back(
        {"ambient", AmbientLight{ambient_.value_or(intensity)}, {scene_.path.string(), 0, 0}});
    for (const auto& [mesh, polygons] : polygons_) {
        free_diagonals(mesh->positions, polygons, mesh->triangles);
    }
    for (MeshDescription& mesh : scene_.meshes) make_normals_unit(*mesh.mesh);
    if (degenerate_ != 0) {
        diagnostics_.warning({scene_.path.string(), 0, 0},
                             degenerate_ == 1 ? "1 primitive without extent is ignored"
                                              : std::to_string(degenerate_) +
                                                    " primitives without extent are ignored");
    }
    if (scene_.materials.empty()) set_fill({{1, 1, 1}, {1, 1, 1}, {}, 0, 0, 1}, {});
}

}  // namespace alhazen
