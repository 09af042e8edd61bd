#pragma once
/// Reads a material library (MTL) without interpreting it.
///
/// Source: "Material Library File (.mtl)", Alias/Wavefront, 1995; Exocortex, "Extending the
/// Wavefront MTL format for Physically Based Rendering", 2014 (Pr, Pm, Pc, Pcr, norm and maps).
/// Differs: no finding is an error. Spectral curves, CIE XYZ colours and unreadable numbers are
/// warnings; one more lists what is unknown or out of its range.
/// Conventions: names extend to the end of their line; of equal names the first is used.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/shading/materials/material.h"

namespace alhazen {

/// An image file and its options.
struct MtlMap {
    std::string file;  ///< as written, or empty: none
    Vec2 offset{0, 0}, scale{1, 1};
    bool clamp = false;
    double gain = 1;                 ///< -mm
    double bump = 1;                 ///< -bm
    std::optional<Channel> channel;  ///< -imfchan
    FileLocation location;
};

struct MtlMaterial {
    std::string name;
    std::optional<Rgb> ka, kd, ks, ke, tf;
    std::optional<double> ns, ni, d, tr, pr, pm, pc, pcr;
    std::optional<int> illum;
    MtlMap map_ka, map_kd, map_ks, map_ke, map_ns, map_d, map_pr, map_pm, normal, map_bump;
    FileLocation location;
};

/// Limit on materials per library; further ones are dropped with a warning.
inline constexpr std::size_t kMaxMtlMaterials = 65536;

/// The materials of a library. All findings are warnings.
[[nodiscard]] std::vector<MtlMaterial> read_mtl(std::string_view bytes, const std::string& file,
                                                Diagnostics& diagnostics);

}  // namespace alhazen
