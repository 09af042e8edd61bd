// Readers of nodes and scenes.
#include <cmath>

#include "alhazen/formats/gltf/document/gltf_matrix.h"
#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

/// True if the columns are mutually perpendicular and none is 0, up to rounding.
bool is_trs(const std::array<double, 16>& m) {
    constexpr double kLargestCosine = 1e-3;
    const auto dot = [&](std::size_t i, std::size_t j) {
        return m[4 * i] * m[4 * j] + m[4 * i + 1] * m[4 * j + 1] + m[4 * i + 2] * m[4 * j + 2];
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const double lengths = std::sqrt(dot(i, i)) * std::sqrt(dot(j, j));
        if (!(lengths > 0) || std::abs(dot(i, j)) > kLargestCosine * lengths) return false;
    }
    return true;
}

/// Reads a matrix; warns of the first rounded matrix of a document.
void read_matrix(const JsonObject& object, Node& node, bool& reported_rounding) {
    std::array<double, 16> matrix{};
    if (!object.has("matrix")) return;
    object.numbers_into("matrix", matrix);
    node.matrix = matrix;
    for (const char* other : {"translation", "rotation", "scale"}) {
        if (object.has(other)) object.error(other, "a node with a matrix must not have it");
    }
    const LastRow last_row = matrix_of(matrix.data()).last_row;
    if (last_row == LastRow::Perspective) {
        object.error("matrix", "the last row must be 0, 0, 0, 1");
    } else if (last_row == LastRow::Rounded && !reported_rounding) {
        reported_rounding = true;
        object.warning("matrix", kRoundedMatrices);
    }
    if (!is_trs(matrix)) {
        object.error("matrix", "the matrix is not a product of translation, rotation and scale");
    }
}

void read_rotation(const JsonObject& object, Node& node) {
    constexpr double kTolerance = 0.00769;  // for quaternions written with few digits
    object.numbers_into("rotation", node.rotation, {-1 - kTolerance, 1 + kTolerance});
    double squared = 0;
    for (const double q : node.rotation) squared += q * q;
    const double length = std::sqrt(squared);
    if (length < kTolerance) {
        object.error("rotation", "a quaternion of length 0 is not a rotation");
        return;
    }
    if (std::abs(length - 1) > kTolerance) {
        object.error("rotation", "the quaternion is not of unit length, but of " + written(length));
    }
    for (double& q : node.rotation) q /= length;
}

void read_instances(const JsonObject& object, Node& node) {
    object.with_extension("EXT_mesh_gpu_instancing", [&](const JsonObject& extension) {
        extension.require("attributes");
        extension.with_object("attributes", [&](const JsonObject& attributes) {
            for (const std::string& name : attributes.keys()) {
                const auto accessor = attributes.index(name, Collection::Accessors);
                if (accessor) node.instances[name] = *accessor;
            }
            if (attributes.keys().empty()) attributes.error({}, "there is no attribute");
        });
        if (!object.has("mesh")) object.error({}, "there are instances but no mesh");
    });
}

Node read_node(const JsonObject& object, bool& reported_rounding) {
    Node node;
    node.name = object.text("name").value_or("");
    node.children = object.indices("children", Collection::Nodes);
    node.mesh = object.index("mesh", Collection::Meshes);
    node.skin = object.index("skin", Collection::Skins);
    node.camera = object.index("camera", Collection::Cameras);
    object.with_extension("KHR_lights_punctual", [&](const JsonObject& extension) {
        extension.require("light");
        node.light = extension.index("light", Collection::Lights);
    });
    object.with_extension("KHR_node_visibility", [&](const JsonObject& extension) {
        node.visible = extension.flag("visible", true);
    });
    node.weights = object.numbers("weights", 0).value_or(std::vector<double>());
    for (const char* key : {"skin", "weights"}) {
        if (object.has(key) && !object.has("mesh")) object.error(key, "not allowed without a mesh");
    }
    read_matrix(object, node, reported_rounding);
    object.numbers_into("translation", node.translation);
    object.numbers_into("scale", node.scale);
    read_rotation(object, node);
    read_instances(object, node);
    return node;
}

}  // namespace

void read_nodes(const JsonObject& root, Loading& loading) {
    bool reported_rounding = false;
    root.each_object("nodes", [&](const JsonObject& object, std::size_t) {
        loading.document.nodes.push_back(read_node(object, reported_rounding));
    });
    root.each_object("scenes", [&](const JsonObject& object, std::size_t) {
        loading.document.scenes.push_back(
            {object.text("name").value_or(""), object.indices("nodes", Collection::Nodes)});
    });
    loading.document.scene = root.index("scene", Collection::Scenes);
}

}  // namespace alhazen::gltf
