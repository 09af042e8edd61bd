#pragma once
/// Small pictures with adaptive supersampling, as the camera of SceneMaker sees them.

#include "alhazen/renderers/core/reports/antialias_report.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/scene_maker.h"

namespace alhazen::testing {

inline constexpr int kSide = 16;
/// Side of a pixel at the origin: 5 tan(0.35) is half of the picture.
inline constexpr double kPixel = 2 * 5 * 0.36502849483904305 / kSide;

struct AntialiasedPicture {
    Film film{kSide, kSide, {0, 0, kSide, kSide}};
    RenderReport report;
    [[nodiscard]] const AntialiasReport& counts() const { return *report.antialias; }
};

inline AntialiasedPicture picture(const Scene& scene, const AntialiasSettings& settings,
                                  const Renderer& renderer = Whitted{}, int threads = 2,
                                  AovFilm* aovs = nullptr) {
    AntialiasedPicture result;
    RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
    job.antialias = &settings;
    job.control.threads = threads;
    job.aovs = aovs;
    result.report = renderer.render(job, result.film);
    return result;
}

/// An emitting material, visible without lights.
inline MaterialId bright(SceneMaker& maker) {
    Material m;
    m.emission.color = {1, 1, 1};
    return maker.material(m);
}

}  // namespace alhazen::testing
