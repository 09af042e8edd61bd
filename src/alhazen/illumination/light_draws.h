#pragma once
/// `Illumination::draw` for eight points at once: rectangles in lanes, other lights one by one.

#include <array>
#include <cstddef>

#include "alhazen/illumination/illumination.h"
#include "alhazen/illumination/rectangle_lanes.h"

namespace alhazen {

class LightDraws {
  public:
    static constexpr std::size_t kMost = RectangleLanes::kMost;

    /// `lights` must outlive the object, unchanged.
    explicit LightDraws(const Illumination& lights) : lights_(lights) {}

    [[nodiscard]] std::size_t size() const { return size_; }
    /// Adds a call of `Illumination::draw`; at most kMost before `clear`. `waves` must stay valid
    /// until `draw`.
    void add(const LitPoint& at, double choice, const Vec2& u, const Wavelengths& waves);
    void draw();
    /// The result of the i-th `add`; valid after `draw`.
    [[nodiscard]] const LightDraw& operator[](std::size_t i) const { return drawn_[i]; }
    void clear() { size_ = in_lanes_ = 0; }

  private:
    /// A draw of a rectangle, waiting in its lane.
    struct Waiting {
        std::size_t draw, light;
        double probability;
        Vec3 at;
        const Wavelengths* waves;
    };

    const Illumination& lights_;
    RectangleLanes rectangles_;
    std::array<Waiting, kMost> waiting_;  ///< [lane]
    std::array<LightDraw, kMost> drawn_;
    std::size_t size_ = 0, in_lanes_ = 0;
};

}  // namespace alhazen
