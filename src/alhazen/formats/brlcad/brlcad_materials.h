#pragma once
/// Materials of BRL-CAD's shaders, and the state that combinations hand down to their regions.
///
/// Source: BRL-CAD, manual pages of `rt` and of its shaders (plastic, mirror, glass, light) for
/// names and values of their parameters. Differs: shaders that make a pattern (cloud, checker,
/// textures, bumps) are shown as plain plastic, with a warning; light shines through its own
/// source. Conventions: colours 0..1, linear as in BRL-CAD's pictures.

#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "alhazen/formats/brlcad/brlcad_database.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Colour and shader that hold at a place of the tree above the regions.
struct BrlcadState {
    std::optional<Rgb> color;
    std::string shader;
    bool color_fixed = false, shader_fixed = false;  ///< nothing below changes it

    /// That of the members of a combination.
    [[nodiscard]] BrlcadState below(const BrlcadCombination& comb) const;
    [[nodiscard]] auto key() const {
        const Rgb c = color.value_or(Rgb{-1, -1, -1});
        return std::make_tuple(c.r, c.g, c.b, shader, color_fixed, shader_fixed);
    }
};

/// The share that a region with the shader `light` has in the light of the scene.
struct BrlcadLight {
    Rgb color;
    double intensity = 1;
    bool shown = true;
    bool infinite = false;  ///< as from far away
};

class BrlcadMaterials {
  public:
    BrlcadMaterials(const BrlcadDatabase& database, SceneDescription& scene,
                    Diagnostics& diagnostics)
        : database_(database), scene_(scene), diagnostics_(diagnostics) {}

    /// The material of a region in that state; `region_id` may change its colour by the database's
    /// table. 0 for what is in no region.
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
    std::set<std::string> told_;  ///< shaders that there was a warning about
};

}  // namespace alhazen
