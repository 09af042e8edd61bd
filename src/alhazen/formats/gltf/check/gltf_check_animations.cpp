// Checks that skins and animations refer to suitable nodes and accessors.
#include <map>
#include <set>

#include "alhazen/formats/gltf/document/gltf_accessors.h"
#include "alhazen/formats/gltf/document/gltf_readers.h"
#include "alhazen/formats/gltf/scene/gltf_node_tree.h"

namespace alhazen::gltf {

namespace {

void check_bind_matrices(const Loading& loading, const Skin& skin, const std::string& place) {
    if (!skin.inverse_bind_matrices) return;
    const Accessor& matrices = loading.document.accessors[*skin.inverse_bind_matrices];
    if (matrices.type != ElementType::Mat4 || matrices.component != ComponentType::Float) {
        loading.error(place, "the accessor must be MAT4 of FLOAT");
    }
    if (matrices.count < skin.joints.size()) {
        loading.error(place, std::to_string(matrices.count) + " matrices for " +
                                 std::to_string(skin.joints.size()) + " joints");
    }
}

/// Checks that each scene with a skinned mesh contains the joints of its skin.
void check_scenes_of_skins(const Loading& loading, const NodeTree& tree) {
    const Document& document = loading.document;
    // Joints without a common root are reported elsewhere, so the first joint stands for all.
    for (std::size_t i = 0; i < document.scenes.size(); ++i) {
        const std::vector<Index>& nodes = document.scenes[i].nodes;
        const std::set<Index> roots(nodes.begin(), nodes.end());
        for (std::size_t j = 0; j < document.nodes.size(); ++j) {
            const Node& node = document.nodes[j];
            if (!node.skin || !node.mesh || document.skins[*node.skin].joints.empty()) continue;
            const Index joint = document.skins[*node.skin].joints.front();
            if (roots.count(tree.root_of(static_cast<Index>(j))) == 0 ||
                roots.count(tree.root_of(joint)) != 0) {
                continue;
            }
            loading.error(pointer_to("scenes", i), "node " + std::to_string(j) +
                                                       " has a skin whose joints are not in the "
                                                       "scene");
            break;
        }
    }
}

void check_joints(const Loading& loading, const NodeTree& tree, const Skin& skin,
                  const std::string& place) {
    for (const Index joint : skin.joints) {
        if (tree.is_in_loop(joint)) return;  // reported already
    }
    bool one_root = true;
    for (const Index joint : skin.joints) {
        one_root = one_root && tree.root_of(joint) == tree.root_of(skin.joints.front());
        if (skin.skeleton && !tree.contains(*skin.skeleton, joint)) {
            loading.error(place + "/skeleton",
                          "node " + std::to_string(*skin.skeleton) + " is not above all joints");
            return;
        }
    }
    if (!one_root) loading.error(place + "/joints", "the joints have no common root");
}

bool is_number(const Accessor& accessor, bool integers) {
    if (accessor.component == ComponentType::Float) return true;
    return integers && accessor.normalized;
}

class AnimationChecker {
  public:
    AnimationChecker(const Loading& loading, const Animation& animation, std::string place)
        : loading_(loading),
          document_(loading.document),
          animation_(animation),
          place_(std::move(place)) {}

    void run() {
        for (std::size_t i = 0; i < animation_.samplers.size(); ++i) {
            const AnimationSampler& sampler = animation_.samplers[i];
            const Accessor& input = document_.accessors[sampler.input];
            const std::string place = place_ + "/samplers/" + std::to_string(i) + "/input";
            if (input.type != ElementType::Scalar || input.component != ComponentType::Float) {
                loading_.error(place, "times must be SCALAR of FLOAT");
            } else if (input.min.empty() || input.max.empty()) {
                loading_.error(place, "the accessor must have min and max");
            }
            if (sampler.interpolation == Interpolation::CubicSpline && input.count < 2) {
                loading_.error(place, "a cubic spline needs at least 2 times");
            }
        }
        for (std::size_t i = 0; i < animation_.channels.size(); ++i) {
            channel(i, place_ + "/channels/" + std::to_string(i));
        }
    }

  private:
    void channel(std::size_t position, const std::string& place) {
        const AnimationChannel& channel = animation_.channels[position];
        if (!channel.node) return;
        const auto [other, fresh] = targets_.try_emplace({*channel.node, channel.path}, position);
        if (!fresh) {
            loading_.error(place + "/target",
                           "the same target as channel " + std::to_string(other->second));
        }
        const Node& node = document_.nodes[*channel.node];
        std::uint64_t per_key = 1;
        if (channel.path == AnimationPath::Weights) {
            per_key =
                node.mesh ? document_.meshes[*node.mesh].primitives.front().targets.size() : 0;
            if (per_key == 0) {
                loading_.error(place + "/target", "the node has no mesh with morph targets");
                return;
            }
        } else if (node.matrix) {
            loading_.error(place + "/target", "a node with a matrix cannot be animated");
        }
        output(animation_.samplers[channel.sampler], channel.path, per_key, place + "/sampler");
    }

    void output(const AnimationSampler& sampler, AnimationPath path, std::uint64_t per_key,
                const std::string& place) const {
        const Accessor& output = document_.accessors[sampler.output];
        const std::uint64_t keys = document_.accessors[sampler.input].count;
        const bool quaternion = path == AnimationPath::Rotation;
        const ElementType type = quaternion                       ? ElementType::Vec4
                                 : path == AnimationPath::Weights ? ElementType::Scalar
                                                                  : ElementType::Vec3;
        const bool integers = quaternion || path == AnimationPath::Weights;
        if (output.type != type || !is_number(output, integers)) {
            loading_.error(place, std::string("the output must be ") + name_of(type) + " of FLOAT" +
                                      (integers ? " or of normalised integers" : ""));
        }
        const bool cubic = sampler.interpolation == Interpolation::CubicSpline;
        // No overflow: counts are below 2^53 and larger accessors were rejected.
        const std::uint64_t each = per_key * (cubic ? 3 : 1);
        if (output.count % each == 0 && output.count / each == keys) return;
        loading_.error(place, "the output has " + std::to_string(output.count) +
                                  " elements, expected " + std::to_string(each) + " for each of " +
                                  std::to_string(keys) + " times");
    }

    const Loading& loading_;
    const Document& document_;
    const Animation& animation_;
    std::string place_;
    std::map<std::pair<Index, AnimationPath>, std::size_t> targets_;  ///< index of the channel
};

}  // namespace

void check_skins_and_animations(const Loading& loading) {
    const Document& document = loading.document;
    if (!document.skins.empty()) {
        const NodeTree tree(document.nodes);
        for (std::size_t i = 0; i < document.skins.size(); ++i) {
            const Skin& skin = document.skins[i];
            const std::string place = pointer_to("skins", i);
            check_bind_matrices(loading, skin, place + "/inverseBindMatrices");
            check_joints(loading, tree, skin, place);
        }
        check_scenes_of_skins(loading, tree);
    }
    for (std::size_t i = 0; i < document.animations.size(); ++i) {
        AnimationChecker(loading, document.animations[i], pointer_to("animations", i)).run();
    }
}

}  // namespace alhazen::gltf
