#pragma once
/// Measures several accelerators on one scene under equal conditions: `alhazen compare`
/// (docs/reference/compare.md).
///
/// Source: Havran and Sixta, "Comparison of Hierarchical Grids", Ray Tracing News 12(1), 1999, and
/// Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987 (what is
/// counted).
/// Differs: every accelerator traces the same recorded rays, and its hits are compared bit by bit.
/// It also renders the picture, which must be bit-identical and cast the same rays.
/// Conventions: seconds are processor time on one thread. The accelerator `list` and others that
/// would take too long are measured on a sample, and marked.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/progress.h"
#include "alhazen/imaging/image/encoding.h"
#include "alhazen/laboratory/scene_trial.h"

namespace alhazen {

struct CompareOptions {
    /// "NAME" or "NAME:SETTING=VALUE,..."; `list` and `wide_bvh` are added if missing.
    std::vector<std::string> accelerators;
    bool tune = true;  ///< accelerators without settings: measures the best settings found, too
    double time_limit = 10;  ///< seconds for each of: counts, times, picture; twice for the search
    TrialOptions trial;
    ProgressSink* progress = nullptr;
    const StopFlag* stop = nullptr;
};

/// Splits "a,b:x=1,y=2,c" into accelerators; "all" is every one. Throws Error (Usage) for an
/// unknown accelerator or setting.
[[nodiscard]] std::vector<std::string> parse_accelerators(std::string_view list);

/// The picture of an accelerator, compared with the reference.
struct PictureCheck {
    std::uint64_t pixels = 0;     ///< number compared
    std::uint64_t differing = 0;  ///< number of these that differ in any bit
    bool complete = true;         ///< false: only randomly spread tiles were rendered
    bool same_rays = true;        ///< equal numbers of rays cast and hits, by kind
};

struct Measurement {
    enum class Variant { Default, Tuned, Given };

    std::string accelerator;  ///< as built, with its settings
    Variant variant = Variant::Default;
    std::string unavailable;  ///< reason if it could not be built; else empty
    double build_seconds = 0;
    std::uint64_t bytes = 0;  ///< size of the acceleration structures after all rays
    ReplayFigures figures;
    PictureCheck picture;
    int tried = 0;  ///< number of builds of the search; 0 without a search
    bool search_cut_short = false;
    /// [height][width] nodes and cells visited plus bounds and primitives tested, over all rays of
    /// the pixel; NaN if not rendered.
    std::vector<float> cost;

    [[nodiscard]] bool agrees() const {
        return figures.disagreements == 0 && picture.differing == 0 && picture.same_rays;
    }
    [[nodiscard]] std::string name() const { return accelerator.substr(0, accelerator.find(':')); }
    /// The settings; empty for the defaults.
    [[nodiscard]] std::string settings() const;
};

struct Comparison {
    std::string scene;
    int width = 0, height = 0;
    SceneCensus census;
    RayCounters rays;  ///< of the picture
    std::array<std::uint64_t, kRayKindCount> recorded{};
    std::vector<double> picture;  ///< radiance [height][width][3]
    Encoding encoding = Encoding::Srgb;
    std::vector<Measurement> measurements;

    /// The measurement with default settings of that name, or null.
    [[nodiscard]] const Measurement* find(std::string_view name) const;
    [[nodiscard]] bool holds() const;  ///< all accelerators that could be built agree
};

/// Runs the comparison. `scene` names the scene in messages and reports. Throws Error as SceneTrial
/// does, and Error (Render) when stopped.
[[nodiscard]] Comparison compare(SceneDescription description, const std::string& scene,
                                 const CompareOptions& options);

}  // namespace alhazen
