#pragma once
/// `Illumination::draw` for up to sixteen points at once: choices in a light tree and rectangles in
/// lanes, searches in a picture of the environment by turns, other lights one by one.
///
/// Differs from it: directions to the picture of the environment from below a point that counts
/// light of one side have density 0, without a search for their radiance.

#include <array>
#include <cstddef>
#include <cstdint>

#include "alhazen/illumination/area_lanes.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/illumination/light_chooser.h"
#include "alhazen/illumination/light_lanes.h"
#include "alhazen/illumination/rectangle_lanes.h"
#include "alhazen/shading/lights/environment.h"

namespace alhazen {

class LightDraws {
  public:
    static constexpr std::size_t kMost = LightCallLanes::kMost;

    /// `lights` must outlive the object, unchanged.
    explicit LightDraws(const Illumination& lights);

    [[nodiscard]] std::size_t size() const { return size_; }
    /// Adds a call of `Illumination::draw`; at most kMost before `clear`. `waves` must stay valid
    /// until `draw`.
    void add(const LitPoint& at, double choice, const Vec2& u, const Wavelengths& waves);
    /// The arguments of `draw(count)`, of which the caller fills the first `count` lanes.
    [[nodiscard]] LightCallLanes& calls() { return calls_; }
    void draw();
    /// As `draw` after `count` calls of `add`, for colour channels.
    void draw(std::size_t count);
    /// Lane i is the result of the i-th `add`. Valid after `draw`.
    [[nodiscard]] const LightDrawLanes& results() const { return results_; }
    [[nodiscard]] LightDraw operator[](std::size_t i) const { return results_[i]; }
    void clear() {
        size_ = 0;
        spectral_ = 0;
    }

  private:
    /// A draw in a picture of the environment.
    struct SkyDraw {
        std::size_t lane;
        ChosenLight chosen;
    };

    void draw_far(std::uint32_t lanes);
    void draw_sky(std::size_t count);
    void draw_near(std::uint32_t lanes);
    /// Lanes that are left to be drawn.
    struct Left {
        std::uint32_t near_flat = 0;  ///< with a FlatEmitter that is near, in colour channels
        std::uint32_t others = 0;
    };
    /// Draws the flat emitters of the scene that are sampled by area.
    [[nodiscard]] Left draw_by_area(std::uint32_t lanes, const ChosenLight* chosen);
    /// Draws flat emitters that are near, but rectangles, which are set in their lanes and
    /// returned.
    [[nodiscard]] std::uint32_t draw_near_flat(std::uint32_t lanes, const ChosenLight* chosen);
    /// Draws all chosen lights but rectangles, which are set in their lanes and returned.
    [[nodiscard]] std::uint32_t draw_near_part(std::uint32_t lanes, const ChosenLight* chosen);
    /// Chooses a near light for each of `lanes`: chosen[lane].
    void choose_near(std::uint32_t lanes, ChosenLight* chosen);
    void set_rectangle(std::size_t lane, const ChosenLight& chosen);
    /// Samples the rectangles that are set in `lanes`.
    void draw_rectangles(std::uint32_t lanes);

    const Illumination& lights_;
    LightCallLanes calls_;
    std::array<const Wavelengths*, kMost> waves_;  ///< [lane]
    std::uint32_t spectral_ = 0;                   ///< lanes whose wavelengths are spectral
    std::size_t size_ = 0;
    std::array<SkyDraw, kMost> sky_draws_;
    std::array<Environment::Search, kMost> searches_;  ///< [sky draw]
    ChosenLight sole_;  ///< the near light if there is only one; else with probability 0
    bool sole_is_rectangle_ = false;  ///< that RectangleLanes takes
    AreaLanes by_area_;
    RectangleLanes rectangles_;
    std::array<std::size_t, kMost> rectangle_lights_ = {};  ///< [lane]
    LightDrawLanes results_;
};

}  // namespace alhazen
