#include "alhazen/formats/ray/ray_family.h"

#include <algorithm>
#include <vector>

#include "alhazen/formats/ray/ray_extensions.h"

namespace alhazen {

namespace {

constexpr double kLargestScaledShininess = 2.0;
constexpr double kShininessScale = 128.0;

struct Signs {
    bool dictionary_spelling = false;
    bool token_spelling = false;
    double largest_shininess = 0.0;
};

bool has_name_pair(TextNode block) {
    return std::any_of(block.begin(), block.end(),
                       [](TextNode item) { return item.is(NodeKind::Pair, "name"); });
}

void look_at(TextNode node, Signs& signs) {
    const std::string_view name = node.text();
    if (node.is(NodeKind::Entry)) {
        if (name == "material" || is_dictionary_extension(name)) signs.dictionary_spelling = true;
    } else if (node.is(NodeKind::Pair)) {
        if (name == "quaternian") {
            signs.token_spelling = true;
        } else if (name == "gennormals" || name == "quaternion" || name == "focaldistance" ||
                   name == "aperture" || name == "enable_motion_blur") {
            signs.dictionary_spelling = true;
        } else if (name == "material" && !node.empty() && node.first().is(NodeKind::Block)) {
            if (has_name_pair(node.first())) signs.dictionary_spelling = true;
        } else if (name == "shininess" && !node.empty()) {
            signs.largest_shininess = std::max(signs.largest_shininess, node.first().number());
        }
    }
}

/// Number lists contain no indications of the family; skipping them keeps this fast for meshes.
Signs signs_of(TextNode root) {
    Signs signs;
    std::vector<TextNode> pending{root};
    while (!pending.empty()) {
        const TextNode node = pending.back();
        pending.pop_back();
        look_at(node, signs);
        if (node.is(NodeKind::Pair) &&
            (node.text() == "points" || node.text() == "faces" || node.text() == "normals")) {
            continue;
        }
        for (const TextNode child : node) {
            // `gennormals;` and `name x;`: only the token parsers accept words without a value or
            // an equals sign.
            if (child.is(NodeKind::Word, "gennormals") || child.is(NodeKind::Word, "name") ||
                child.is(NodeKind::Entry, "name")) {
                signs.token_spelling = true;
            }
            const bool leaf = child.is(NodeKind::Number) || child.is(NodeKind::Word) ||
                              child.is(NodeKind::String);
            if (!leaf) pending.push_back(child);
        }
    }
    return signs;
}

Conventions conventions_of(bool dictionary) {
    Conventions c;
    c.shading.highlight = ShadingConventions::Highlight::Phong;
    c.shading.shadow_tint = dictionary ? ShadingConventions::ShadowTint::PerCrossing
                                       : ShadingConventions::ShadowTint::PerDistance;
    c.shading.refraction_tint = dictionary ? ShadingConventions::RefractionTint::PerEvent
                                           : ShadingConventions::RefractionTint::PerDistance;
    c.shading.ambient_factor = ShadingConventions::AmbientFactor::Ambient;
    c.shading.ambient_inside_times_kt = false;
    c.shading.correct_interpolated_normals = false;
    c.shading.clamp_attenuation = true;
    c.shading.air_index = 1.0;
    c.sampling.pixel_sample = SamplingConventions::PixelSample::LowerLeftCorner;
    c.importing.headlight = false;
    c.film.linear_output = true;
    // The programs of the courses start with depth 0, adjusted by a slider; reflection and glass
    // need more.
    c.shading.max_depth = 5;
    return c;
}

}  // namespace

RayFamily detect_ray_family(TextNode root) {
    const Signs signs = signs_of(root);
    const bool small_shininess =
        signs.largest_shininess > 0 && signs.largest_shininess <= kLargestScaledShininess;
    RayFamily family;
    family.dictionary = signs.dictionary_spelling || (small_shininess && !signs.token_spelling);
    if (family.dictionary && signs.largest_shininess <= kLargestScaledShininess) {
        family.shininess_scale = kShininessScale;
    }
    family.conventions = conventions_of(family.dictionary);
    return family;
}

}  // namespace alhazen
