#pragma once
/// The measured angular distribution of a luminaire: an IES file.
///
/// Source: Illuminating Engineering Society, "ANSI/IESNA LM-63-02: Standard File Format for the
/// Electronic Transfer of Photometric Data", 2002. Files of 1986 and 1991 have no line with
/// ":LM-63-" at their head, and a ballast-lamp photometric factor, which multiplies the candela; in
/// its place is a number without effect since 1995 (reserved) and 2019 (how the file was made).
/// Differs: photometric type C only; a tilt is read and ignored (`ignored_tilt`).
/// Conventions: candela are interpolated in both angles. Horizontal angles that end at 0, 90 or 180
/// are continued by symmetry, others periodically. Below the first and above the last vertical
/// angle the intensity is 0. A light of color 1 with inverse-square attenuation emits candela / 683
/// watts per steradian.
/// Threads: const functions may be called concurrently.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/shading/lights/light.h"

namespace alhazen {

/// Luminous efficacy at the eye's peak sensitivity, lumens per watt.
inline constexpr double kLumensPerWatt = 683.0;

class IesProfile {
  public:
    static constexpr std::size_t kMostAngles = 4096, kMostBytes = std::size_t{16} << 20;

    /// Parses a file. Throws Error (Scene) with the line of the fault; `name` is used in messages.
    IesProfile(std::string_view text, const std::string& name);

    /// Luminous intensity; `vertical` from straight down and `horizontal` around it, in radians.
    [[nodiscard]] double candela(double vertical, double horizontal) const;
    [[nodiscard]] double largest_candela() const { return largest_; }
    /// Total luminous flux: the exact integral of `candela`.
    [[nodiscard]] double lumens() const;
    /// "INCLUDE" or a file name: what the file gives of the lamp's dependence on the luminaire's
    /// tilt, which is not applied; empty if nothing, or factors of 1.
    [[nodiscard]] const std::string& ignored_tilt() const { return ignored_tilt_; }
    /// The line, from 1, of text behind the last value, which is not read; 0: there is none.
    [[nodiscard]] int line_of_surplus() const { return line_of_surplus_; }
    /// The text of the file.
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    [[nodiscard]] double value(std::size_t horizontal, std::size_t vertical) const {
        return candela_[horizontal * verticals_.size() + vertical];
    }

    std::string text_, ignored_tilt_;
    std::vector<double> verticals_, horizontals_;  ///< radians, ascending
    std::vector<double> candela_;                  ///< [horizontal][vertical]
    double largest_ = 0;
    int line_of_surplus_ = 0;
};

/// The factor on the light's colour along a unit direction from the light; 1 without a profile.
[[nodiscard]] double profile_factor(const LightProfile& profile, const Vec3& from_light);
/// The maximum of `profile_factor`, and its mean over all directions.
[[nodiscard]] double largest_factor(const LightProfile& profile);
[[nodiscard]] double mean_factor(const LightProfile& profile);

}  // namespace alhazen
