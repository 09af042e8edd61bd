// Checks that nodes form a forest, scenes name its roots, and skins and weights suit the meshes.
#include "alhazen/formats/gltf/document/gltf_readers.h"
#include "alhazen/formats/gltf/scene/gltf_node_tree.h"

namespace alhazen::gltf {

namespace {

constexpr Index kNone = ~Index{0};

void check_parents(const Loading& loading) {
    const std::vector<Node>& nodes = loading.document.nodes;
    std::vector<Index> parents(nodes.size(), kNone);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const Index child : nodes[i].children) {
            if (parents[child] == kNone) {
                parents[child] = static_cast<Index>(i);
                continue;
            }
            loading.error(pointer_to("nodes", i), "node " + std::to_string(child) +
                                                      " is a child of node " +
                                                      std::to_string(parents[child]) + " already");
        }
    }
}

void check_scenes(const Loading& loading, const NodeTree& tree) {
    const Document& document = loading.document;
    for (std::size_t i = 0; i < document.scenes.size(); ++i) {
        for (const Index node : document.scenes[i].nodes) {
            if (!tree.has_parent(node)) continue;
            loading.error(pointer_to("scenes", i),
                          "node " + std::to_string(node) + " is the child of another node");
        }
    }
}

bool has_attribute(const Mesh& mesh, const char* name) {
    for (const Primitive& primitive : mesh.primitives) {
        if (primitive.attributes.count(name) != 0) return true;
    }
    return false;
}

void check_node(const Loading& loading, const std::vector<bool>& skinned_meshes, const Node& node,
                const std::string& place) {
    if (!node.mesh) return;
    const Mesh& mesh = loading.document.meshes[*node.mesh];
    const std::size_t targets = mesh.primitives.front().targets.size();
    if (!node.weights.empty() && node.weights.size() != targets) {
        loading.error(place + "/weights", std::to_string(node.weights.size()) + " weights for " +
                                              std::to_string(targets) + " morph targets");
    }
    const bool skinned = skinned_meshes[*node.mesh];
    if (node.skin && !skinned) loading.error(place, "there is a skin, but the mesh has no joints");
    if (!node.skin && skinned) {
        loading.warning(place, "the mesh has joints, but there is no skin");
    }
}

void check_instances(const Loading& loading, const Node& node, const std::string& place) {
    struct Expected {
        const char* name;
        ElementType type;
        bool integers;
    };
    constexpr Expected kExpected[] = {{"TRANSLATION", ElementType::Vec3, false},
                                      {"ROTATION", ElementType::Vec4, true},
                                      {"SCALE", ElementType::Vec3, false}};
    const std::vector<Accessor>& accessors = loading.document.accessors;
    std::optional<std::uint64_t> count;
    for (const auto& [name, index] : node.instances) {
        const Accessor& accessor = accessors[index];
        if (count.value_or(accessor.count) != accessor.count) {
            loading.error(place, name + " has " + std::to_string(accessor.count) +
                                     " elements, others have " + std::to_string(*count));
        }
        count = accessor.count;
        for (const Expected& expected : kExpected) {
            if (name != expected.name) continue;
            const bool integer =
                accessor.normalized && (accessor.component == ComponentType::Byte ||
                                        accessor.component == ComponentType::Short);
            const bool good =
                accessor.component == ComponentType::Float || (expected.integers && integer);
            if (accessor.type != expected.type || !good) {
                loading.error(place, "the accessor of " + name + " has the wrong type");
            }
        }
    }
}

}  // namespace

NodeTree::NodeTree(const std::vector<Node>& nodes)
    : parents_(nodes.size(), kNone), roots_(nodes.size(), kNone), spans_(nodes.size()) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const Index child : nodes[i].children) {
            if (parents_[child] == kNone) parents_[child] = static_cast<Index>(i);
        }
    }
    struct Open {
        Index node;
        std::size_t next_child;
    };
    std::vector<Open> open;
    std::uint32_t clock = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (parents_[i] != kNone) continue;
        const Index root = static_cast<Index>(i);
        open.push_back({root, 0});
        roots_[root] = root;
        spans_[root].enter = clock++;
        while (!open.empty()) {
            Open& top = open.back();
            const Node& node = nodes[top.node];
            if (top.next_child == node.children.size()) {
                spans_[top.node].leave = clock;
                open.pop_back();
                continue;
            }
            const Index child = node.children[top.next_child++];
            if (parents_[child] != top.node || roots_[child] != kNone) continue;
            roots_[child] = root;
            spans_[child].enter = clock++;
            open.push_back({child, 0});
        }
    }
}

bool NodeTree::has_parent(Index node) const {
    return parents_[node] != kNone;
}
bool NodeTree::is_in_loop(Index node) const {
    return roots_[node] == kNone;
}
Index NodeTree::root_of(Index node) const {
    return roots_[node];
}
bool NodeTree::contains(Index ancestor, Index node) const {
    return spans_[ancestor].enter <= spans_[node].enter &&
           spans_[node].enter < spans_[ancestor].leave;
}

void check_graph(const Loading& loading) {
    const std::vector<Node>& nodes = loading.document.nodes;
    check_parents(loading);
    const NodeTree tree(nodes);
    // Once per mesh: many nodes may share a mesh of many primitives.
    std::vector<bool> skinned;
    for (const Mesh& mesh : loading.document.meshes) {
        skinned.push_back(has_attribute(mesh, "JOINTS_0"));
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::string place = pointer_to("nodes", i);
        if (tree.is_in_loop(static_cast<Index>(i))) {
            loading.error(place, "the node is in a loop or below one");
        }
        check_node(loading, skinned, nodes[i], place);
        check_instances(loading, nodes[i], place + "/extensions/EXT_mesh_gpu_instancing");
    }
    check_scenes(loading, tree);
}

}  // namespace alhazen::gltf
