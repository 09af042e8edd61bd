#pragma once
/// The passes of `vcm`: stored light paths, and pairs of subpaths for the picture.

#include <cstdint>

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"

namespace alhazen {

/// Use of a pilot run.
enum class Pilot : std::uint8_t {
    Off,
    Say,     ///< report whether merging pays
    Choose,  ///< report it, and merge accordingly
};
inline constexpr const char* kPilotNames[] = {"off", "say", "choose"};

struct VcmSettings {
    bool merge = true;  ///< false: the picture is that of `bidirectional`
    Pilot pilot = Pilot::Say;
    std::uint64_t photons = 0;  ///< light paths of a pass to merge with; 0: one for each pixel of
                                ///< the frame, kUsualMost at most
    double radius = 0;          ///< radius of the first pass; 0: three pixels
    double alpha = 0.75;        ///< share of the photons of each further pass that is kept
    double memory = 512;        ///< limit for a pass, in megabytes
    PathSettings paths;

    static constexpr std::uint64_t kUsualMost = 200000;
};

/// Replaces zero photons and radius by their defaults.
[[nodiscard]] VcmSettings resolved(const VcmSettings& settings, const RenderJob& job,
                                   const Film& film);

/// Counts of a render.
struct MergeWork {
    std::uint64_t light_rays = 0;  ///< rays of the light paths for merging
    std::uint64_t merged = 0;      ///< merged pairs of vertices
};

/// `settings` must be resolved; runs no pilot.
[[nodiscard]] RenderReport render_merging(const RenderJob& job, Film& film,
                                          const VcmSettings& settings, MergeWork& work);

}  // namespace alhazen
