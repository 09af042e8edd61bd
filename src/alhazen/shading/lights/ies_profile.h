#pragma once
/// How much a luminaire sends in each direction, measured: an IES file.
///
/// Source: Illuminating Engineering Society, "ANSI/IESNA LM-63-02: Standard File Format for the
/// Electronic Transfer of Photometric Data", 2002; those of 1986, 1991 and 1995 differ in their
/// first lines only.
/// Differs: photometric type C only; a tilt is read and left out.
/// Conventions: candela are interpolated in both angles. Horizontal angles that end at 0, 90 or 180
/// are continued by symmetry, others are taken round. Below the first and above the last vertical
/// angle nothing is sent. A light of color 1 that falls with the square of the distance sends
/// candela / 683 watts per steradian.
/// Threads: const functions may be called from many.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/shading/lights/light.h"

namespace alhazen {

/// Lumens of a watt of the light that the eye sees best.
inline constexpr double kLumensPerWatt = 683.0;

class IesProfile {
  public:
    static constexpr std::size_t kMostAngles = 4096, kMostBytes = std::size_t{16} << 20;

    /// Throws Error (Scene) with the line that is wrong; `name` is used in messages.
    IesProfile(std::string_view text, const std::string& name);

    /// `vertical` from straight down, `horizontal` around it; radians.
    [[nodiscard]] double candela(double vertical, double horizontal) const;
    [[nodiscard]] double largest_candela() const { return largest_; }
    /// Over all directions.
    [[nodiscard]] double lumens() const;
    /// The file.
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    [[nodiscard]] double value(std::size_t horizontal, std::size_t vertical) const {
        return candela_[horizontal * verticals_.size() + vertical];
    }

    std::string text_;
    std::vector<double> verticals_, horizontals_;  ///< radians, ascending
    std::vector<double> candela_;                  ///< [horizontal][vertical]
    double largest_ = 0;
};

/// What the profile multiplies the colour of its light by along a unit direction from the light; 1
/// without a profile.
[[nodiscard]] double profile_factor(const LightProfile& profile, const Vec3& from_light);
/// The largest of these, and their mean over all directions.
[[nodiscard]] double largest_factor(const LightProfile& profile);
[[nodiscard]] double mean_factor(const LightProfile& profile);

}  // namespace alhazen
