#include "alhazen/formats/gltf/document/gltf_document.h"

#include <algorithm>

#include "alhazen/formats/gltf/document/gltf_glb.h"
#include "alhazen/formats/gltf/document/gltf_json.h"
#include "alhazen/formats/gltf/document/gltf_readers.h"
#include "alhazen/formats/pictures/texture_table.h"

namespace alhazen::gltf {

namespace {

struct Named {
    const char* name;
    Collection collection;
};
constexpr Named kTopLevel[] = {
    {"accessors", Collection::Accessors},
    {"buffers", Collection::Buffers},
    {"bufferViews", Collection::BufferViews},
    {"cameras", Collection::Cameras},
    {"images", Collection::Images},
    {"materials", Collection::Materials},
    {"meshes", Collection::Meshes},
    {"nodes", Collection::Nodes},
    {"samplers", Collection::Samplers},
    {"scenes", Collection::Scenes},
    {"skins", Collection::Skins},
    {"textures", Collection::Textures},
};

/// Limit on the number of values of the JSON text. A low limit on elements applies to the buffers,
/// not to the names in a file.
std::uint64_t max_values(const ImportOptions& options) {
    constexpr std::uint64_t kElementsPerValue = 20, kLeast = 1'000'000;
    return std::max(kLeast, options.max_elements / kElementsPerValue);
}

/// A list of distinct names.
std::vector<std::string> names_in(const JsonObject& root, std::string_view key) {
    std::vector<std::string> names;
    const nlohmann::json* list = root.find(key);
    if (list == nullptr) return names;
    if (!list->is_array() || list->empty()) {
        root.error(key, "expected a non-empty array of names");
        return names;
    }
    for (const nlohmann::json& name : *list) {
        if (name.is_string()) {
            names.push_back(name.get<std::string>());
        } else {
            root.error(key, "expected names, found another type");
        }
    }
    const std::set<std::string> distinct(names.begin(), names.end());
    if (distinct.size() != names.size()) root.error(key, "a name occurs more than once");
    return names;
}

void count_arrays(const JsonObject& root, Loading& loading) {
    for (const Named& entry : kTopLevel) {
        const nlohmann::json* list = root.find(entry.name);
        if (list == nullptr || !list->is_array()) continue;
        if (list->size() > std::numeric_limits<Index>::max() / 2) {
            throw Error(ErrorKind::Resource, std::string("too many ") + entry.name);
        }
        loading.sizes[static_cast<std::size_t>(entry.collection)] = list->size();
    }
    const auto count_in_extension = [&](const char* name, const char* key, Collection collection) {
        root.with_extension(name, [&](const JsonObject& extension) {
            const nlohmann::json* list = extension.find(key);
            if (list == nullptr || !list->is_array()) return;
            loading.sizes[static_cast<std::size_t>(collection)] = list->size();
        });
    };
    count_in_extension("KHR_lights_punctual", "lights", Collection::Lights);
    count_in_extension("KHR_materials_variants", "variants", Collection::Variants);
}

/// Parses a version, such as "2.0" -> {2, 0}.
std::optional<std::array<int, 2>> version_in(const JsonObject& asset, std::string_view key) {
    const auto text = asset.text(key);
    if (!text) return std::nullopt;
    const std::size_t dot = text->find('.');
    const auto is_number = [](std::string_view digits) {
        return !digits.empty() && digits.size() < 6 &&
               digits.find_first_not_of("0123456789") == std::string_view::npos;
    };
    if (dot == std::string::npos || !is_number(text->substr(0, dot)) ||
        !is_number(text->substr(dot + 1))) {
        asset.error(key, "expected a version such as \"2.0\"");
        return std::nullopt;
    }
    return std::array<int, 2>{std::stoi(text->substr(0, dot)), std::stoi(text->substr(dot + 1))};
}

/// Reads all arrays; false after an error.
void read_all(const JsonObject& root, Loading& loading) {
    read_buffers(root, loading);
    read_accessors(root, loading);
    read_textures(root, loading);
    read_materials(root, loading);
    read_meshes(root, loading);
    read_cameras(root, loading);
    read_lights(root, loading);
    read_nodes(root, loading);
    read_animations(root, loading);
}

/// Makes accessors in buffers without data zeros, like those without a view.
void zeros_without_data(Loading& loading) {
    Document& document = loading.document;
    const auto lacks_data = [&](Index view) {
        return document.buffers[document.views[view].buffer].lacks_data;
    };
    for (Accessor& accessor : document.accessors) {
        if (accessor.sparse && (lacks_data(accessor.sparse->indices_view) ||
                                lacks_data(accessor.sparse->values_view))) {
            accessor.sparse.reset();
        }
        if (!accessor.view || !lacks_data(*accessor.view)) continue;
        accessor.view.reset();
        accessor.offset = 0;
    }
}

}  // namespace

std::string pointer_to(const char* collection, std::size_t position) {
    return std::string("#/") + collection + '/' + std::to_string(position);
}

std::string pointer_to(const char* collection, std::size_t position, const char* part,
                       std::size_t part_position) {
    return pointer_to(collection, position) + '/' + part + '/' + std::to_string(part_position);
}

Loading::Loading(const ImportSource& from, Diagnostics& findings)
    : JsonContext{findings, from.path.string(), {}, {}},
      source(from),
      folder(folder_of(from.path)),
      roots(scene_roots(from.options, folder)) {}

void read_asset(const JsonObject& root) {
    root.require("asset");
    root.with_object("asset", [](const JsonObject& asset) {
        asset.require("version");
        for (const char* key : {"copyright", "generator"}) (void)asset.text(key);
        const auto version = version_in(asset, "version");
        const auto minimum = version_in(asset, "minVersion");
        if (version && (*version)[0] != 2) {
            asset.error("version", "only glTF 2.0 is supported, found version " +
                                       std::to_string((*version)[0]) + "." +
                                       std::to_string((*version)[1]));
        }
        if (minimum && version && *minimum > *version) {
            asset.error("minVersion", "greater than version");
        } else if (minimum && *minimum > std::array<int, 2>{2, 0}) {
            asset.warning("minVersion", "a later version is required; read as 2.0");
        } else if (version && *version > std::array<int, 2>{2, 0} && (*version)[0] == 2) {
            asset.warning("version", "later than 2.0; read as 2.0");
        }
    });
}

bool read_extensions(const JsonObject& root, Loading& loading) {
    Document& document = loading.document;
    std::string missing;
    for (const std::string& name : document.extensions_required) {
        if (is_supported(name) || is_only_look(name)) continue;
        missing += (missing.empty() ? "" : ", ") + name;
    }
    if (!missing.empty()) {
        root.error("extensionsRequired", "requires extensions that are not supported: " + missing);
        return false;
    }
    for (const std::string& name : document.extensions_required) {
        if (loading.extensions_used.count(name) != 0) continue;
        root.error("extensionsRequired", name + " is not listed in extensionsUsed");
    }
    std::set<std::string_view> told;
    for (const std::string& name : document.extensions_used) {
        if (is_supported(name) || !told.insert(name).second) continue;
        root.warning("extensionsUsed",
                     "the extension " + name + " is not supported; " +
                         (is_only_look(name) ? "it is left out of the look" : "ignored"));
    }
    constexpr const char* kQuantization = "KHR_mesh_quantization";
    loading.quantized = loading.extensions_used.count(kQuantization) != 0;
    const auto& required = document.extensions_required;
    if (loading.quantized &&
        std::find(required.begin(), required.end(), kQuantization) == required.end()) {
        root.error("extensionsUsed",
                   std::string(kQuantization) + " must be listed in extensionsRequired as well");
    }
    count_arrays(root, loading);
    return true;
}

Document read_gltf_document(const ImportSource& source, Diagnostics& diagnostics) {
    Loading loading(source, diagnostics);
    const std::size_t errors_before = diagnostics.error_count();
    const auto failed = [&] { return diagnostics.error_count() != errors_before; };
    {
        const auto container = open_container(source.bytes, loading.file, diagnostics);
        if (!container) return {};
        loading.binary = container->binary;
        loading.is_glb = container->is_glb;
        auto tree =
            parse_json(container->json, loading.file, max_values(source.options), diagnostics);
        if (!tree) return {};
        const Place top;
        {
            // A separate JsonObject: the next one needs the declared extensions.
            for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
                if (!tree->contains(key)) continue;
                nlohmann::json only = {{key, (*tree)[key]}};
                auto& list = key == std::string_view("extensionsUsed")
                                 ? loading.document.extensions_used
                                 : loading.document.extensions_required;
                list = names_in(JsonObject(only, top, loading), key);
            }
            const auto& used = loading.document.extensions_used;
            loading.extensions_used.insert(used.begin(), used.end());
        }
        JsonObject root(*tree, top, loading);
        if (!read_extensions(root, loading)) return {};
        read_asset(root);
        if (failed()) return {};
        read_all(root, loading);
    }
    if (failed()) return {};
    check_layout(loading);
    check_usage(loading);
    check_images(loading);
    check_graph(loading);
    check_meshes(loading);
    check_skins_and_animations(loading);
    if (failed()) return std::move(loading.document);
    zeros_without_data(loading);
    check_data(loading);
    return std::move(loading.document);
}

}  // namespace alhazen::gltf
