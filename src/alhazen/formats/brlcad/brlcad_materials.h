#pragma once
/// Materials from BRL-CAD's shaders, and the state that regions inherit from combinations.
///
/// Source: BRL-CAD, manual pages of `rt` and of its shaders for names and values of their
/// parameters.
/// Differs: patterns (checker, testmap, cloud) use the texture coordinates of Alhazen's shapes; an
/// environment is a single colour; textures and bumps become plain plastic, with a warning. The
/// solid of a light does not occlude its own light.
/// Conventions: colours 0..1, linear as in BRL-CAD's images.

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "alhazen/formats/brlcad/brlcad_database.h"
#include "alhazen/formats/brlcad/brlcad_patterns.h"
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

/// The light of a region with the shader `light`.
struct BrlcadLight {
    Rgb color;
    double intensity = 1;
    double fraction = -1;        ///< of full light; <= 0: by intensity
    double angle_deg = 180;      ///< half the angle of its beam
    std::optional<Vec3> target;  ///< a point on the beam's axis; none: -z of the light's solid
    bool shown = true;
    bool infinite = false;  ///< directional, at infinity
};

class BrlcadMaterials {
  public:
    BrlcadMaterials(const BrlcadDatabase& database, SceneDescription& scene,
                    Diagnostics& diagnostics)
        : database_(database), scene_(scene), diagnostics_(diagnostics) {}

    /// The material of a region in that state. A region without a colour has the colour of the
    /// colour table for its `region_id`, which is 0 outside regions. `unit`: length of a pattern in
    /// the texture coordinates of the region's shapes.
    MaterialId of(const BrlcadState& state, int region_id, const Vec2& unit,
                  const BrlcadPlace& place);
    /// True for a region with the shader envmap, which is not a solid; the first one sets the
    /// background.
    bool takes_environment(const BrlcadState& state, int region_id, const BrlcadPlace& place);
    [[nodiscard]] const BrlcadLight* light(MaterialId material) const {
        const auto found = lights_.find(material);
        return found == lights_.end() ? nullptr : &found->second;
    }
    [[nodiscard]] const std::map<MaterialId, BrlcadLight>& lights() const { return lights_; }

  private:
    Material make(const std::vector<BrlcadShader>& shaders, const Rgb& color, const Vec2& unit,
                  const BrlcadPlace& place, std::optional<BrlcadLight>& light);
    TextureId texture_of(BrlcadPattern pattern, const Vec2& unit, const BrlcadPlace& place);
    [[nodiscard]] Rgb color_of(const BrlcadState& state, int region_id) const;
    void tell_once(const std::string& message, const BrlcadPlace& place);
    void tell_unknown(const BrlcadShader& shader, std::span<const std::string_view> known,
                      const BrlcadPlace& place);

    const BrlcadDatabase& database_;
    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    std::map<std::tuple<double, double, double, std::string, double, double>, MaterialId> known_;
    std::map<MaterialId, BrlcadLight> lights_;
    std::set<std::string> reported_;  ///< warnings already given
    bool has_environment_ = false;
};

}  // namespace alhazen
