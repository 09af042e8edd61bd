#pragma once
/// Materials from BRL-CAD's shaders, and the state that regions inherit from combinations.
///
/// Source: BRL-CAD, manual pages of `rt` and of its shaders (plastic, mirror, glass, light) for
/// names and values of their parameters.
/// Differs: pattern shaders (cloud, checker, textures, bumps) become plain plastic, with a warning.
/// The solid of a light does not block its own light.
/// Conventions: colours 0..1, linear as in BRL-CAD's images.

#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "alhazen/formats/brlcad/brlcad_database.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Colour and shader inherited at a position in the tree above the regions.
struct BrlcadState {
    std::optional<Rgb> color;
    std::string shader;
    bool color_fixed = false, shader_fixed = false;  ///< overrides everything below

    /// The state for the members of a combination.
    [[nodiscard]] BrlcadState below(const BrlcadCombination& comb) const;
    [[nodiscard]] auto key() const {
        const Rgb c = color.value_or(Rgb{-1, -1, -1});
        return std::make_tuple(c.r, c.g, c.b, shader, color_fixed, shader_fixed);
    }
};

/// Light source of a region with the shader `light`.
struct BrlcadLight {
    Rgb color;
    double intensity = 1;
    bool shown = true;
    bool infinite = false;  ///< directional, at infinity
};

class BrlcadMaterials {
  public:
    BrlcadMaterials(const BrlcadDatabase& database, SceneDescription& scene,
                    Diagnostics& diagnostics)
        : database_(database), scene_(scene), diagnostics_(diagnostics) {}

    /// The material of a region in that state. The colour table of the database may override its
    /// colour by `region_id`; 0 outside regions.
    MaterialId of(const BrlcadState& state, int region_id, const BrlcadPlace& place);
    [[nodiscard]] const BrlcadLight* light(MaterialId material) const {
        const auto found = lights_.find(material);
        return found == lights_.end() ? nullptr : &found->second;
    }
    [[nodiscard]] bool has_lights() const { return !lights_.empty(); }

  private:
    Material make(const std::string& shader, const Rgb& color, const BrlcadPlace& place,
                  std::optional<BrlcadLight>& light);

    const BrlcadDatabase& database_;
    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    std::map<std::tuple<double, double, double, std::string>, MaterialId> known_;
    std::map<MaterialId, BrlcadLight> lights_;
    std::set<std::string> told_;  ///< shaders already warned about
};

}  // namespace alhazen
