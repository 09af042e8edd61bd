// Checks that attributes, indices and morph targets of each primitive fit together.
#include <map>
#include <set>

#include "alhazen/formats/gltf/check/gltf_semantics.h"
#include "alhazen/formats/gltf/document/gltf_accessors.h"
#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

/// Type of the accessor for messages: "VEC4 of FLOAT".
std::string description(const Accessor& accessor) {
    return std::string(name_of(accessor.type)) + " of " +
           (accessor.normalized ? "normalised " : "") + name_of(accessor.component);
}

class PrimitiveChecker {
  public:
    PrimitiveChecker(const Loading& loading, const Primitive& primitive, std::string place)
        : loading_(loading),
          document_(loading.document),
          primitive_(primitive),
          place_(std::move(place)) {}

    void run() {
        for (const auto& [name, index] : primitive_.attributes) {
            attribute(name, document_.accessors[index], place_ + "/attributes/" + name, false);
        }
        sets();
        counts();
        if (primitive_.indices) indices();
        for (std::size_t i = 0; i < primitive_.targets.size(); ++i) {
            target(primitive_.targets[i], place_ + "/targets/" + std::to_string(i));
        }
        if (primitive_.material) texture_coordinates();
    }

  private:
    void attribute(const std::string& name, const Accessor& accessor, const std::string& place,
                   bool is_target) const {
        const auto semantic = parse_semantic(name);
        if (!semantic) return loading_.error(place, "there is no attribute of this name");
        if (!suits(*semantic, accessor, is_target, loading_.quantized)) {
            loading_.error(place,
                           "an accessor with " + description(accessor) + " is not allowed here");
        }
        if (name == "POSITION" && (accessor.min.empty() || accessor.max.empty())) {
            loading_.error(place, "the accessor must have min and max");
        }
        if (!accessor.view) return;
        const BufferView& view = document_.views[*accessor.view];
        const std::uint64_t stride =
            view.stride != 0 ? view.stride : layout_of(accessor.component, accessor.type).packed;
        if (accessor.offset % 4 != 0 || view.offset % 4 != 0 || stride % 4 != 0) {
            loading_.error(place, "vertices must be aligned to 4 bytes");
        }
    }

    /// Checks that numbered attributes start at 0 without gaps, and that joints and weights come in
    /// pairs.
    void sets() const {
        std::map<std::string_view, std::set<std::uint32_t>> sets;
        for (const auto& [name, index] : primitive_.attributes) {
            const auto semantic = parse_semantic(name);
            if (semantic && semantic->set) sets[semantic->name].insert(*semantic->set);
        }
        for (const auto& [name, numbers] : sets) {
            if (*numbers.rbegin() + std::size_t{1} == numbers.size()) continue;
            loading_.error(place_ + "/attributes", "the set numbers of " + std::string(name) +
                                                       "_n must start at 0 without gaps");
        }
        if (sets["JOINTS"].size() != sets["WEIGHTS"].size()) {
            loading_.error(place_ + "/attributes", "there must be as many JOINTS_n as WEIGHTS_n");
        }
        const auto has = [&](const char* name) { return primitive_.attributes.count(name) != 0; };
        if (!has("POSITION"))
            loading_.warning(place_, "there are no positions; the primitive is invisible");
        if (has("TANGENT") && !has("NORMAL")) {
            loading_.warning(place_, "there are tangents without normals");
        }
    }

    void counts() {
        for (const auto& [name, index] : primitive_.attributes) {
            const std::uint64_t count = document_.accessors[index].count;
            if (!vertices_) vertices_ = count;
            if (*vertices_ == count) continue;
            loading_.error(place_ + "/attributes/" + name, std::to_string(count) +
                                                               " elements, other attributes have " +
                                                               std::to_string(*vertices_));
        }
        const std::uint64_t n = primitive_.indices ? document_.accessors[*primitive_.indices].count
                                                   : vertices_.value_or(0);
        const PrimitiveMode mode = primitive_.mode;
        const bool strip =
            mode == PrimitiveMode::TriangleStrip || mode == PrimitiveMode::TriangleFan;
        if ((mode == PrimitiveMode::Triangles && n % 3 != 0) || (strip && n < 3)) {
            loading_.warning(place_, std::to_string(n) +
                                         " vertices or indices do not make whole "
                                         "triangles");
        }
    }

    void indices() const {
        const Accessor& accessor = document_.accessors[*primitive_.indices];
        const std::string place = place_ + "/indices";
        const bool integers = accessor.component == ComponentType::UnsignedByte ||
                              accessor.component == ComponentType::UnsignedShort ||
                              accessor.component == ComponentType::UnsignedInt;
        if (accessor.type != ElementType::Scalar || !integers || accessor.normalized) {
            loading_.error(place,
                           "indices must be SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or "
                           "UNSIGNED_INT, found " +
                               description(accessor));
        }
        if (accessor.view && document_.views[*accessor.view].stride != 0) {
            loading_.error(place, "the buffer view of indices must not have a stride");
        }
    }

    void target(const Attributes& attributes, const std::string& place) const {
        for (const auto& [name, index] : attributes) {
            const Accessor& accessor = document_.accessors[index];
            const std::string at = place + "/" + name;
            attribute(name, accessor, at, true);
            const auto base = primitive_.attributes.find(name);
            if (base == primitive_.attributes.end()) {
                if (!name.empty() && name[0] == '_') continue;
                loading_.error(at, "the primitive has no such attribute");
            } else if (document_.accessors[base->second].count != accessor.count) {
                loading_.error(at, std::to_string(accessor.count) +
                                       " elements, the primitive has " +
                                       std::to_string(document_.accessors[base->second].count));
            }
        }
    }

    void texture_coordinates() const {
        const Material& material = document_.materials[*primitive_.material];
        const auto lacks = [&](const char* name) { return primitive_.attributes.count(name) == 0; };
        if (material.anisotropy > 0 && lacks("TANGENT") && lacks("TEXCOORD_0") &&
            !material.normal_texture) {
            loading_.warning(place_ + "/material",
                             "the material is anisotropic, and the primitive has no tangents and "
                             "no TEXCOORD_0; its directions are arbitrary");
        }
        for (const auto* info :
             {&material.base_color_texture, &material.metallic_roughness_texture,
              &material.normal_texture, &material.occlusion_texture, &material.emissive_texture,
              &material.transmission_texture, &material.thickness_texture,
              &material.specular_texture, &material.specular_color_texture, &material.coat_texture,
              &material.coat_roughness_texture, &material.coat_normal_texture,
              &material.sheen_color_texture, &material.sheen_roughness_texture,
              &material.iridescence_texture, &material.film_thickness_texture,
              &material.anisotropy_texture, &material.diffuse_transmission_texture,
              &material.diffuse_transmission_color_texture}) {
            if (*info && !has_coordinates(**info)) return;
        }
        if (const auto& old = material.specular_glossiness) {
            for (const auto* info : {&old->diffuse_texture, &old->specular_glossiness_texture}) {
                if (*info && !has_coordinates(**info)) return;
            }
        }
    }

    [[nodiscard]] bool has_coordinates(const TextureInfo& info) const {
        const std::string name = "TEXCOORD_" + std::to_string(info.tex_coord);
        if (primitive_.attributes.count(name) != 0) return true;
        loading_.error(place_ + "/material", "a texture of material " +
                                                 std::to_string(*primitive_.material) +
                                                 " needs the attribute " + name);
        return false;
    }

    const Loading& loading_;
    const Document& document_;
    const Primitive& primitive_;
    std::string place_;
    std::optional<std::uint64_t> vertices_;
};

}  // namespace

void check_meshes(const Loading& loading) {
    const std::vector<Mesh>& meshes = loading.document.meshes;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Mesh& mesh = meshes[i];
        const std::size_t targets = mesh.primitives.front().targets.size();
        for (std::size_t j = 0; j < mesh.primitives.size(); ++j) {
            const Primitive& primitive = mesh.primitives[j];
            const std::string place = pointer_to("meshes", i, "primitives", j);
            PrimitiveChecker(loading, primitive, place).run();
            if (primitive.targets.size() != targets) {
                loading.error(place, "all primitives of a mesh must have as many morph targets");
            }
        }
        if (!mesh.weights.empty() && mesh.weights.size() != targets) {
            loading.error(pointer_to("meshes", i), std::to_string(mesh.weights.size()) +
                                                       " weights for " + std::to_string(targets) +
                                                       " morph targets");
        }
    }
}

}  // namespace alhazen::gltf
