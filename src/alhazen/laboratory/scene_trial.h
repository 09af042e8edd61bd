#pragma once
/// A scene, the recorded rays of its picture, and the results of each accelerator.
///
/// Conventions: everything runs on one thread; seconds are processor time. The rays are those of
/// the renderer `whitted` with the accelerator `wide_bvh`. All accelerators must find the same
/// hits, hence cast the same rays; this is checked.

#include <optional>
#include <string>

#include "alhazen/laboratory/replay.h"
#include "alhazen/scene/scene.h"
#include "alhazen/session/render.h"

namespace alhazen {

struct TrialOptions {
    std::optional<int> width, height;  ///< default: the scene's
    int longest_side = 256;            ///< of the picture if no size is given
    bool spd = false;                  ///< true: counts as published, by Protocol::Spd
    std::optional<int> max_depth;      ///< default: the scene's
    std::string camera;
    std::string csg = "event_heap";
    std::size_t most_rays = 2'000'000;  ///< limit of recorded rays; 72 bytes each
};

/// A compiled scene with its build time.
struct BuiltScene {
    Scene scene;
    double seconds = 0;
};

class SceneTrial {
  public:
    /// Renders the picture and records its rays. `description` must be valid; a missing camera or
    /// light is added. Throws Error as `compile`, `render` and `complete_view` do.
    SceneTrial(SceneDescription description, const TrialOptions& options);

    [[nodiscard]] const SceneDescription& description() const { return description_; }
    [[nodiscard]] const Scene& reference() const { return reference_.scene; }
    [[nodiscard]] const RayStream& stream() const { return stream_; }
    /// The picture rendered with `wide_bvh`.
    [[nodiscard]] const RenderResult& picture() const { return picture_; }
    /// Size, depth and camera; one thread.
    [[nodiscard]] const RenderOptions& render_options() const { return render_options_; }
    [[nodiscard]] const PictureSettings& picture_settings() const { return description_.picture; }

    /// The eye ray of a pixel, counted from the top left. Throws Error (Usage) for a pixel outside.
    [[nodiscard]] Ray eye_ray_of(int x, int y) const;

    /// Compiles the scene with an accelerator. Throws Error as `compile` does.
    [[nodiscard]] BuiltScene build(const std::string& accelerator) const;
    /// Replays the rays on `scene` and compares with the results of `wide_bvh`.
    [[nodiscard]] ReplayFigures ask(const Scene& scene, const ReplayOptions& options);
    /// Builds an accelerator and replays the rays on it.
    [[nodiscard]] ReplayFigures ask(const std::string& accelerator, const ReplayOptions& options) {
        return ask(build(accelerator).scene, options);
    }

  private:
    SceneDescription description_;
    std::string csg_;
    RenderOptions render_options_;
    BuiltScene reference_;
    RenderResult picture_;
    RayStream stream_;
    Answers answers_;
};

}  // namespace alhazen
