// Readers of skins and animations.
#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

Skin read_skin(const JsonObject& object) {
    Skin skin;
    skin.name = object.text("name").value_or("");
    skin.inverse_bind_matrices = object.index("inverseBindMatrices", Collection::Accessors);
    object.require("joints");
    skin.joints = object.indices("joints", Collection::Nodes);
    skin.skeleton = object.index("skeleton", Collection::Nodes);
    return skin;
}

AnimationSampler read_sampler(const JsonObject& object) {
    AnimationSampler sampler;
    object.require("input");
    object.require("output");
    sampler.input = object.index("input", Collection::Accessors).value_or(0);
    sampler.output = object.index("output", Collection::Accessors).value_or(0);
    const std::string name = object.text("interpolation").value_or("LINEAR");
    if (name == "STEP") {
        sampler.interpolation = Interpolation::Step;
    } else if (name == "CUBICSPLINE") {
        sampler.interpolation = Interpolation::CubicSpline;
    } else if (name != "LINEAR") {
        object.warning("interpolation", "expected LINEAR, STEP or CUBICSPLINE; taken as LINEAR");
    }
    return sampler;
}

void read_target(const JsonObject& target, AnimationChannel& channel) {
    target.require("path");
    const std::string path = target.text("path").value_or("");
    channel.node = target.index("node", Collection::Nodes);
    if (path == "translation") {
        channel.path = AnimationPath::Translation;
    } else if (path == "rotation") {
        channel.path = AnimationPath::Rotation;
    } else if (path == "scale") {
        channel.path = AnimationPath::Scale;
    } else if (path == "weights") {
        channel.path = AnimationPath::Weights;
    } else {
        channel.node.reset();
        if (path != "pointer") {
            target.warning("path", "expected translation, rotation, scale or weights; ignored");
        }
    }
    // The channels of this extension are ignored, but contradictions in the file are errors.
    target.with_extension("KHR_animation_pointer", [&](const JsonObject& extension) {
        channel.node.reset();
        if (target.has("node")) extension.error({}, "the target must not have a node as well");
        if (path != "pointer") extension.error({}, "the path of the target must be \"pointer\"");
        extension.require("pointer");
        (void)extension.text("pointer");
    });
}

Animation read_animation(const JsonObject& object) {
    Animation animation;
    animation.name = object.text("name").value_or("");
    object.require("channels");
    object.require("samplers");
    object.each_object("samplers", [&](const JsonObject& sampler, std::size_t) {
        animation.samplers.push_back(read_sampler(sampler));
    });
    object.each_object("channels", [&](const JsonObject& entry, std::size_t) {
        AnimationChannel channel;
        entry.require("sampler");
        entry.require("target");
        const std::uint64_t sampler = entry.integer("sampler").value_or(0);
        if (sampler >= animation.samplers.size()) {
            entry.error("sampler", "there is no sampler " + std::to_string(sampler) + ", only " +
                                       std::to_string(animation.samplers.size()));
        } else {
            channel.sampler = static_cast<Index>(sampler);
        }
        entry.with_object("target",
                          [&](const JsonObject& target) { read_target(target, channel); });
        animation.channels.push_back(channel);
    });
    return animation;
}

}  // namespace

void read_animations(const JsonObject& root, Loading& loading) {
    root.each_object("skins", [&](const JsonObject& object, std::size_t) {
        loading.document.skins.push_back(read_skin(object));
    });
    root.each_object("animations", [&](const JsonObject& object, std::size_t) {
        loading.document.animations.push_back(read_animation(object));
    });
}

}  // namespace alhazen::gltf
