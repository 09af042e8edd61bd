#pragma once
/// Tone mapping from radiance to display values: white balance, exposure and a curve.
///
/// Source: Reinhard, Stark, Shirley and Ferwerda, "Photographic Tone Reproduction for Digital
/// Images", SIGGRAPH 2002, equation 4; Narkowicz, "ACES Filmic Tone Mapping Curve", 2016; Sobotka,
/// "AgX", 2022, by the polynomial of Wrensch, "Minimal AgX Implementation", 2023; Lindbloom,
/// "Chromatic Adaptation" (Bradford's matrix); CIE 15:2004 (daylight); Kang et al., "Design of
/// Advanced Color Temperature Control System for HDTV Applications", 2002 (below 4000 K).
/// Differs: Reinhard's key and burn-out are fixed: exposure is explicit, and luminance 4 is white.
/// Conventions: linear values with the primaries of sRGB, before the transfer curve. NaN stays NaN.

#include <span>
#include <string>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

enum class ToneCurve { None, Reinhard, Aces, Agx };
/// [ToneCurve] names.
inline constexpr const char* kToneCurveNames[] = {"none", "reinhard", "aces", "agx"};

struct ToneMapping {
    static constexpr double kLeastKelvin = 1667, kMostKelvin = 25000;

    ToneCurve curve = ToneCurve::None;
    double stops = 0;   ///< values are multiplied by 2^stops
    double kelvin = 0;  ///< temperature of the light that becomes white; 0: no change

    [[nodiscard]] bool changes_nothing() const {
        return curve == ToneCurve::None && stops == 0.0 && kelvin == 0.0;
    }
};

/// Maps pixels. Threads: const functions may be called from several threads.
class ToneMapper {
  public:
    explicit ToneMapper(const ToneMapping& mapping);
    [[nodiscard]] Rgb operator()(const Rgb& radiance) const;

  private:
    ToneMapping mapping_;
    double scale_;
    Rgb balance_[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< rows
};

}  // namespace alhazen
