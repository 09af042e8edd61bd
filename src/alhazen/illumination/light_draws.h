#pragma once
/// `Illumination::draw` for eight points at once: choices in a light tree and rectangles in lanes,
/// searches in a picture of the environment by turns, other lights one by one.
///
/// Differs from it: directions to the picture of the environment from below a point that counts
/// light of one side have density 0, without a search for their radiance.

#include <array>
#include <cstddef>

#include "alhazen/illumination/illumination.h"
#include "alhazen/illumination/light_tree_lanes.h"
#include "alhazen/illumination/rectangle_lanes.h"
#include "alhazen/shading/lights/environment.h"

namespace alhazen {

class LightDraws {
  public:
    static constexpr std::size_t kMost = RectangleLanes::kMost;
    static_assert(kMost == LitPointLanes::kMost);

    /// `lights` must outlive the object, unchanged.
    explicit LightDraws(const Illumination& lights) : lights_(lights) {}

    [[nodiscard]] std::size_t size() const { return size_; }
    /// Adds a call of `Illumination::draw`; at most kMost before `clear`. `waves` must stay valid
    /// until `draw`.
    void add(const LitPoint& at, double choice, const Vec2& u, const Wavelengths& waves);
    void draw();
    /// Results of `Illumination::draw` in lanes: lane i is that of the i-th `add`.
    struct Results {
        using Numbers = double[kMost];  ///< [lane]
        alignas(64) Numbers to_light[3] = {};
        alignas(64) Numbers distance = {}, density = {};
        alignas(64) Numbers radiance[Spectrum::kCount] = {};
        std::uint32_t singular = 0;  ///< bits of lanes
        std::array<PlaceInLight, kMost> places;

        void set(std::size_t lane, const LightDraw& draw);
        /// Sets what is not the direction.
        void set(std::size_t lane, const Spectrum& light, bool is_singular,
                 const PlaceInLight& place);
    };
    /// Valid after `draw`.
    [[nodiscard]] const Results& results() const { return results_; }
    /// The result of the i-th `add`; valid after `draw`.
    [[nodiscard]] LightDraw operator[](std::size_t i) const;
    void clear() { size_ = near_ = sky_ = in_lanes_ = 0; }

  private:
    /// A draw of a near light that is not yet chosen.
    struct NearDraw {
        std::size_t draw;
        Vec2 u;
        const Wavelengths* waves;
    };
    /// A draw in a picture of the environment.
    struct SkyDraw {
        std::size_t draw;
        ChosenLight chosen;
        LitPoint at;
        const Wavelengths* waves;
        Environment::Search search;
    };
    /// A draw of a rectangle, waiting in its lane.
    struct Waiting {
        std::size_t draw, light;
        double probability;
        const Wavelengths* waves;
    };

    /// Draws near lights; rectangles are put into their lanes.
    void draw_near();
    void draw_sky();
    /// Samples the rectangles.
    void draw_rectangles();

    const Illumination& lights_;
    std::array<NearDraw, kMost> near_draws_;
    LitPointLanes near_points_;  ///< [near draw]
    ChoiceLanes near_choices_;   ///< [near draw]
    std::array<SkyDraw, kMost> sky_draws_;
    RectangleLanes rectangles_;
    std::array<Waiting, kMost> waiting_;  ///< [lane]
    Results results_;
    std::size_t size_ = 0, near_ = 0, sky_ = 0, in_lanes_ = 0;
};

}  // namespace alhazen
