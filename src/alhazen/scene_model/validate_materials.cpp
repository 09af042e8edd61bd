#include "alhazen/scene_model/validate_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

/// Checks one material or texture; stores its name and location for findings.
class Checker {
  public:
    Checker(const SceneDescription& description, FileLocation where, Diagnostics& diagnostics)
        : d_(description), where_(std::move(where)), out_(diagnostics) {
        if (where_.file.empty()) where_ = {d_.path.string(), 0, 0};
    }

    void error(std::string message) { out_.error(where_, std::move(message)); }

    void material(const Material& m) {
        name_ = m.name.empty() ? "a material" : "material '" + m.name + "'";
        texture_id(m.emission.texture, "emission");
        numbers(m.emission.color, "emission");
        color(m.ambient, "ambient");
        color(m.diffuse, "diffuse");
        color(m.specular, "specular");
        color(m.reflective, "reflective");
        color(m.transmissive, "transmissive");
        scalar(m.shininess, "shininess");
        scalar(m.index, "index of refraction");
        scalar(m.roughness, "roughness");
        if (m.density) not_negative(*m.density, "density");
        scalar(m.alpha, "alpha");
        not_negative(m.alpha_cutoff, "alpha cutoff");
        texture_id(m.normal_map.texture, "normal map");
        const auto map = static_cast<std::size_t>(m.normal_map.texture);
        if (map < d_.textures.size() &&
            std::holds_alternative<SolidTexture>(d_.textures[map].texture)) {
            error(fmt::format("the normal map of {} is a solid texture", name_));
        }
        if (!std::isfinite(m.normal_map.scale)) {
            error(fmt::format("scale of the normal map of {} must be finite", name_));
        }
        if (m.metallic_roughness) parameters(*m.metallic_roughness);
        if (m.conductor) {
            numbers(m.conductor->index, "index of the conductor");
            numbers(m.conductor->extinction, "extinction of the conductor");
        }
        numbers(m.scattering.coefficient, "scattering");
        if (!(std::abs(m.scattering.anisotropy) < 1.0)) {
            error(
                fmt::format("anisotropy of the scattering of {} must be above -1 and "
                            "below 1",
                            name_));
        }
        if (m.dielectric) {
            numbers(m.dielectric->absorption, "absorption");
            if (m.index.value == 0.0) {
                error(fmt::format("index of refraction of the dielectric '{}' must be above 0",
                                  m.name));
            }
        }
        if (int(m.metallic_roughness.has_value()) + int(m.conductor.has_value()) +
                int(m.dielectric.has_value()) >
            1) {
            error(
                fmt::format("{} may be only one of metallic-roughness, conductor and "
                            "dielectric",
                            name_));
        }
        more_light_than_comes(m);
    }

  private:
    /// Warns of colours that light transport clamps: negative ones and those above 1.
    void more_light_than_comes(const Material& m) {
        const auto warn = [&](const ColorInput& input, const char* what) {
            const Rgb& c = input.color;
            if (std::min({c.r, c.g, c.b}) < 0.0) {
                out_.warning(where_, fmt::format("{} of {} is negative; path tracing "
                                                 "takes 0",
                                                 what, name_));
            }
            if (c.max() > 1.0) {
                out_.warning(where_, fmt::format("{} of {} is above 1; path tracing "
                                                 "scales it down",
                                                 what, name_));
            }
        };
        if (m.metallic_roughness) {
            warn(m.metallic_roughness->base_color, "base colour");
            warn(m.metallic_roughness->sheen.color, "sheen colour");
            warn(m.metallic_roughness->diffuse_transmission.color, "diffuse transmission colour");
        } else if (!m.conductor && !m.dielectric) {
            warn(m.diffuse, "diffuse");
            warn(m.reflective, "reflective");
            warn(m.transmissive, "transmissive");
        }
    }

    void numbers(const Rgb& c, const char* what) {
        for (int i = 0; i < 3; ++i) not_negative(c[i], what);
    }

    void parameters(const MetallicRoughness& p) {
        color(p.base_color, "base colour");
        color(p.specular_color, "specular colour");
        color({p.attenuation_color, kNoTexture}, "attenuation colour");
        scalar(p.metallic, "metallic");
        scalar(p.roughness, "roughness");
        scalar(p.occlusion, "occlusion");
        scalar(p.specular, "specular");
        scalar(p.transmission, "transmission");
        scalar(p.thickness, "thickness");
        scalar(p.coat.strength, "strength of the coat");
        scalar(p.coat.roughness, "roughness of the coat");
        texture_id(p.coat.normal_map.texture, "normal map of the coat");
        color(p.sheen.color, "sheen colour");
        scalar(p.sheen.roughness, "sheen roughness");
        scalar(p.film.strength, "strength of the film");
        not_negative(p.film.index, "index of the film");
        not_negative(p.film.thinnest_nm, "thickness of the film");
        not_negative(p.film.thickest_nm, "thickness of the film");
        texture_id(p.film.thickness_texture, "thickness of the film");
        scalar(p.diffuse_transmission.share, "share of the diffuse transmission");
        color(p.diffuse_transmission.color, "diffuse transmission colour");
        not_negative(p.anisotropy.strength, "strength of the anisotropy");
        texture_id(p.anisotropy.texture, "anisotropy");
        if (!std::isfinite(p.anisotropy.rotation)) {
            error(fmt::format("rotation of the anisotropy of {} must be finite", name_));
        }
        not_negative(p.dispersion, "dispersion");
        if (!(p.attenuation_distance > 0.0)) {
            error(fmt::format("attenuation distance of {} must be positive, found {}", name_,
                              p.attenuation_distance));
        }
    }

    void texture_id(TextureId id, const char* what) {
        if (id == kNoTexture || static_cast<std::uint32_t>(id) < d_.textures.size()) return;
        error(fmt::format("{} refers to texture {} of {}", what, static_cast<std::uint32_t>(id),
                          d_.textures.size()));
    }
    void color(const ColorInput& input, const char* what) {
        texture_id(input.texture, what);
        if (!input.color.is_finite()) {
            error(fmt::format("{} of {} must be finite", what, name_));
        }
    }
    void scalar(const ScalarInput& input, const char* what) {
        texture_id(input.texture, what);
        not_negative(input.value, what);
    }
    void not_negative(double value, const char* what) {
        if (std::isfinite(value) && value >= 0.0) return;
        error(
            fmt::format("{} of {} must be finite and not negative, found {}", what, name_, value));
    }

    const SceneDescription& d_;
    FileLocation where_;
    Diagnostics& out_;
    std::string name_;  ///< "material 'x'"
};

void check(const std::string& name, const SolidTexture& solid, Checker& checker) {
    const auto need = [&](bool condition, const char* what) {
        if (!condition) checker.error(fmt::format("solid texture '{}': {}", name, what));
    };
    need(solid.color.is_finite() && solid.other.is_finite(), "its colours must be finite");
    need(is_finite(solid.origin), "its origin must be finite");
    need(std::isfinite(solid.size) && solid.size > 0.0, "its size must be greater than 0");
    need(is_finite(solid.direction) && length_squared(solid.direction) > 0.0,
         "its direction must not be zero");
    need(solid.octaves >= 1 && solid.octaves <= 16, "it has 1 to 16 octaves");
    need(std::isfinite(solid.turbulence), "its turbulence must be finite");
}

void check(const std::string& name, const ImageTexture& texture, Checker& checker) {
    if (!texture.image || texture.image->width <= 0 || texture.image->height <= 0) {
        checker.error(fmt::format("texture '{}' has no image", name));
    }
    if (texture.uv_set != 0 && texture.uv_set != 1) {
        checker.error(fmt::format("texture '{}' uses set {} of coordinates; there are 0 and 1",
                                  name, texture.uv_set));
    }
    const UvTransform& u = texture.uv_transform;
    if (!std::isfinite(u.uu + u.uv + u.vu + u.vv + u.offset.x + u.offset.y)) {
        checker.error(fmt::format("the transform of texture '{}' must be finite", name));
    }
}

}  // namespace

void validate_materials(const SceneDescription& description, Diagnostics& diagnostics) {
    for (const MaterialDescription& m : description.materials) {
        Checker(description, m.location, diagnostics).material(m.material);
    }
    for (const TextureDescription& t : description.textures) {
        Checker checker(description, t.location, diagnostics);
        std::visit([&](const auto& texture) { check(t.name, texture, checker); }, t.texture);
    }
}

}  // namespace alhazen
