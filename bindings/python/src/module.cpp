/// The extension module alhazen._alhazen, which the Python files of the package call.
#include <pybind11/pybind11.h>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/formats/native/read/native_vocabulary.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/session/conversion/convert.h"
#include "array_mesh.h"
#include "built_scene.h"
#include "ray_queries.h"
#include "rendering.h"
#include "solid_queries.h"
#include "surface_queries.h"

namespace py = pybind11;

namespace alhazen::python {

namespace {

/// The value of a key. Throws Error (Usage) that names the call if it has another type.
template <class T>
T value_of(const py::dict& given, const char* key, const char* call = "render") {
    try {
        return given[key].cast<T>();
    } catch (const py::cast_error&) {
        throw Error(ErrorKind::Usage, std::string(call) + ": " + key + " is " +
                                          py::repr(given[key]).cast<std::string>() +
                                          ", which has the wrong type");
    }
}

template <class T>
void take(const py::dict& given, const char* key, T& out, const char* call = "render") {
    if (given.contains(key) && !given[key].is_none()) out = value_of<T>(given, key, call);
}
template <class T>
void take(const py::dict& given, const char* key, std::optional<T>& out,
          const char* call = "render") {
    if (given.contains(key) && !given[key].is_none()) out = value_of<T>(given, key, call);
}

BuildSettings settings_of(const py::dict& given) {
    BuildSettings settings;
    take(given, "accelerator", settings.accelerator, "Scene");
    take(given, "csg", settings.csg, "Scene");
    take(given, "build", settings.quality, "Scene");
    take(given, "threads", settings.threads, "Scene");
    take(given, "strict", settings.strict, "Scene");
    take(given, "allowed_folders", settings.allowed_folders, "Scene");
    take(given, "time", settings.time, "Scene");
    return settings;
}

std::shared_ptr<BuiltScene> build(const py::object& base, const std::vector<ArrayMesh>& meshes,
                                  const std::string& text, const py::list& origins,
                                  const std::string& folder, const py::dict& given) {
    const BuildSettings settings = settings_of(given);
    Origins places;
    for (const auto& item : origins) places.push_back(location_of(item.cast<py::tuple>()));
    const auto* below = base.is_none() ? nullptr : base.cast<const BuiltScene*>();
    const py::gil_scoped_release released;
    return BuiltScene::build(below, meshes, text, places, folder, settings);
}

std::shared_ptr<BuiltScene> load_file(const std::string& path, const py::dict& given,
                                      const std::string& called) {
    const BuildSettings settings = settings_of(given);
    const py::gil_scoped_release released;
    return BuiltScene::load(path, settings, called);
}

/// The files written, and what they do not hold.
std::pair<std::vector<std::string>, std::vector<std::string>> save(const BuiltScene& scene,
                                                                   const std::string& path,
                                                                   bool meshes_only, bool strict) {
    const py::gil_scoped_release released;
    check_convert_target(scene.source().path, path);
    const ConvertOptions options{.meshes_only = meshes_only,
                                 .meshes_only_setting = "meshes_only=True",
                                 .tolerance_setting = "",
                                 .strict = strict};
    const ConvertReport report = convert(scene.source(), path, options);
    std::vector<std::string> files;
    for (const auto& file : report.files) files.push_back(file.string());
    return {std::move(files), conversion_warnings(report)};
}

std::vector<std::string> warnings_of(const BuiltScene& scene) {
    std::vector<std::string> lines;
    for (const Diagnostic& found : scene.loaded().diagnostics.all()) {
        lines.push_back(to_string(found));
    }
    return lines;
}

std::vector<std::string> mesh_names(const BuiltScene& scene) {
    std::vector<std::string> names;
    for (const MeshDescription& mesh : scene.source().meshes) names.push_back(mesh.name);
    return names;
}

std::vector<std::string> geometry_names(const BuiltScene& scene) {
    std::vector<std::string> names;
    std::uint32_t number = 0;
    for (const ObjectDescription& object : scene.loaded().description.objects) {
        for (std::size_t i = 0; i < object.parts.size(); ++i) {
            names.push_back(part_name(scene.loaded().description, number++));
        }
    }
    return names;
}

std::vector<std::string> material_names(const BuiltScene& scene) {
    std::vector<std::string> names;
    for (const Material& material : scene.loaded().scene.materials) names.push_back(material.name);
    return names;
}

std::vector<std::string> camera_names(const BuiltScene& scene) {
    std::vector<std::string> names;
    for (const CameraDescription& camera : scene.source().cameras) names.push_back(camera.name);
    return names;
}

py::dict counts(const BuiltScene& scene) {
    const SceneCensus& census = scene.loaded().scene.census;
    py::dict result;
    result["shapes"] = census.analytic_shapes;
    result["triangles"] = census.triangles;
    result["instances"] = census.instances;
    result["primitives"] = census.effective_primitives;
    result["csg_solids"] = census.solids;
    result["scene_bytes"] = census.scene_bytes;
    result["accelerator_bytes"] = census.accelerator_bytes;
    result["build_seconds"] = scene.loaded().build_seconds;
    return result;
}

py::tuple bounds(const BuiltScene& scene) {
    const Box3 box = scene.tracer().box();
    return py::make_tuple(py::make_tuple(box.lo.x, box.lo.y, box.lo.z),
                          py::make_tuple(box.hi.x, box.hi.y, box.hi.z));
}

py::dict render_with(const BuiltScene& scene, const py::dict& given, const py::object& progress) {
    PictureWishes wishes;
    take(given, "renderer", wishes.render.renderer);
    take(given, "camera", wishes.render.camera);
    take(given, "width", wishes.render.width);
    take(given, "height", wishes.render.height);
    take(given, "depth", wishes.render.max_depth);
    if (const std::optional<int>& depth = wishes.render.max_depth) {
        wishes.render.renderer = with_depth(wishes.render.renderer, *depth);
    }
    take(given, "seed", wishes.render.seed);
    take(given, "threads", wishes.render.threads);
    take(given, "layers", wishes.layers);
    take(given, "environment", wishes.view.environment);
    take(given, "antialias", wishes.antialias);
    if (given.contains("view")) {
        const auto view = value_of<std::string>(given, "view");
        if (!view.empty()) wishes.view.view = parse_view(view);
    }
    take(given, "sampler", wishes.sampling.sampler);
    take(given, "filter", wishes.sampling.filter);
    take(given, "noise", wishes.sampling.noise);
    take(given, "time_limit", wishes.sampling.seconds);
    take(given, "spp", wishes.spp);
    if (given.contains("crop") && !given["crop"].is_none()) {
        const auto [x0, y0, x1, y1] = value_of<std::tuple<int, int, int, int>>(given, "crop");
        wishes.render.crop = PixelBox{x0, y0, x1, y1};
    }
    return render_picture(scene, std::move(wishes), progress);
}

/// [(block, is_shape, [(key, words, required, unit, default)])]
py::list vocabulary() {
    py::list blocks;
    for (const NativeBlockType& type : native_vocabulary()) {
        py::list keys;
        for (const NativeKey& key : type.keys) {
            keys.append(py::make_tuple(key.name, key.words, key.required, key.unit, key.usual));
        }
        blocks.append(py::make_tuple(type.name, type.is_shape, keys));
    }
    return blocks;
}

template <class Table>
py::dict described(const Table& table) {
    py::dict names;
    for (const auto& entry : table) names[py::str(entry.name)] = entry.description;
    return names;
}

BatchOptions batch(RayMask mask, bool coherent, int threads) {
    return {mask, coherent, threads};
}

void add_scene(py::module_& module) {
    py::class_<ArrayMesh>(module, "ArrayMesh")
        .def(py::init(&make_mesh))
        .def(py::pickle(&state_of_mesh, &mesh_of_state))
        .def_readonly("name", &ArrayMesh::name)
        .def("named", [](const ArrayMesh& mesh, const std::string& name) {
            return ArrayMesh{name, mesh.mesh, mesh.location};  // shares the arrays
        });
    py::class_<BuiltScene, std::shared_ptr<BuiltScene>>(module, "BuiltScene")
        .def_static("build", &build)
        .def_static("load", &load_file)
        .def("save", &save)
        .def("path", [](const BuiltScene& scene) { return scene.source().path.string(); })
        .def("warnings", &warnings_of)
        .def("mesh_names", &mesh_names)
        .def("geometry_names", &geometry_names)
        .def("material_names", &material_names)
        .def("camera_names", &camera_names)
        .def("counts", &counts)
        .def("bounds", &bounds)
        .def("intersect",
             [](const BuiltScene& scene, const py::object& rays,
                const std::vector<std::string>& fields, RayMask mask, bool coherent, int threads) {
                 return intersect(scene, rays, fields, batch(mask, coherent, threads));
             })
        .def("occluded",
             [](const BuiltScene& scene, const py::object& rays, RayMask mask, bool coherent,
                int threads) { return occluded(scene, rays, batch(mask, coherent, threads)); })
        .def("all_hits",
             [](const BuiltScene& scene, const py::object& rays, RayMask mask, int threads) {
                 return all_hits(scene, rays, batch(mask, false, threads));
             })
        .def("count_intersections",
             [](const BuiltScene& scene, const py::object& rays, RayMask mask, int threads) {
                 return count_intersections(scene, rays, batch(mask, false, threads));
             })
        .def("spans", &spans)
        .def("thickness", &thickness)
        .def("inside", &inside)
        .def("solids_at", &solids_at)
        .def("closest_points", &closest_points)
        .def("solid_names", &solid_names)
        .def("measure_json", &measure_json)
        .def("section",
             [](const BuiltScene& scene, const std::array<double, 3>& normal, double offset,
                const std::vector<std::string>& words, double tolerance, int cells, int threads) {
                 return section(scene, {normal[0], normal[1], normal[2]}, offset, words, tolerance,
                                cells, threads);
             })
        .def("render", &render_with);
}

}  // namespace

PYBIND11_MODULE(_alhazen, module) {
    module.doc() = "The compiled part of the package alhazen; use the package.";
    translate_errors();
    add_scene(module);
    module.def("vocabulary", &vocabulary);
    module.def("hit_fields", &hit_fields);
    module.def("traced_in_place", &traced_in_place);
    module.def("encode_picture", &encode_picture);
    module.def("renderers", [] { return described(renderers()); });
    module.def("layers", [] { return described(aov_table()); });
    module.def("accelerators", [] { return described(accelerator_table()); });
    module.attr("version") = ALHAZEN_VERSION;
}

}  // namespace alhazen::python
