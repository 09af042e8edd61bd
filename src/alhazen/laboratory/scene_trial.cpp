#include "alhazen/laboratory/scene_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/laboratory/cpu_clock.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/core/samplers.h"
#include "alhazen/session/framing/framing.h"

namespace alhazen {
namespace {

/// Rays per side of Protocol::Spd.
constexpr int kStandardRays = 513;

RenderOptions render_options_of(const SceneDescription& description, const TrialOptions& options) {
    RenderOptions render;
    render.camera = options.camera;
    render.threads = 1;
    render.max_depth = options.max_depth;
    render.width = options.width;
    render.height = options.height;
    if (options.spd) {
        render.width = render.height = kStandardRays;
    } else if (!options.width && !options.height) {
        const PictureSettings& picture = description.picture;
        const bool has_size = picture.width || picture.height || description.cameras.empty();
        const double aspect =
            has_size ? free_aspect(picture, render) : description.cameras.front().aspect;
        const int longest =
            std::min(options.longest_side, std::max(picture.width.value_or(options.longest_side),
                                                    picture.height.value_or(options.longest_side)));
        const auto shorter = [&](double ratio) {
            return std::max(1, static_cast<int>(std::lround(longest * ratio)));
        };
        render.width = aspect >= 1 ? longest : shorter(aspect);
        render.height = aspect >= 1 ? shorter(1 / aspect) : longest;
    }
    return render;
}

}  // namespace

SceneTrial::SceneTrial(SceneDescription description, const TrialOptions& options)
    : description_(std::move(description)),
      csg_(options.csg),
      picture_(Film(1, 1, PixelBox{0, 0, 1, 1})) {
    if (options.spd) {
        apply_spd(description_.conventions.shading, description_.conventions.sampling);
    }
    reference_ = build(kDefaultAccelerator);
    FramingOptions framing;
    framing.camera = options.camera;
    render_options_ = render_options_of(description_, options);
    framing.aspect = static_cast<double>(*render_options_.width) / *render_options_.height;
    (void)complete_view(description_, reference_.scene, framing);

    RenderOptions counting = render_options_;
    counting.count_tests = true;  // makes queries independent of earlier results
    stream_.most = options.most_rays;
    Scene recording = reference_.scene;
    recording.aggregate = std::make_shared<const RayRecorder>(*reference_.scene.aggregate, stream_);
    recording.has_masks = true;  // every query states the kind of its rays
    picture_ = render(recording, description_.picture, counting);
}

Ray SceneTrial::eye_ray_of(int x, int y) const {
    const Film& film = picture_.film;
    const int width = film.frame_width(), height = film.frame_height();
    if (x < 0 || x >= width || y < 0 || y >= height) {
        throw Error(ErrorKind::Usage,
                    fmt::format("pixel {},{} is not in a picture of {}x{}", x, y, width, height));
    }
    const CameraDescription& camera = find_camera(reference_.scene, render_options_.camera);
    const Vec2 p =
        PointSampler(reference_.scene.conventions.sampling.pixel_sample, width, height).at(x, y);
    return eye_ray(with_aspect(camera.camera, camera.aspect, static_cast<double>(width) / height),
                   p.x, p.y);
}

BuiltScene SceneTrial::build(const std::string& accelerator) const {
    BuiltScene built;
    ThreadLimit(1).run([&] {
        const CpuClock clock;
        built.scene = compile(description_, {.accelerator = accelerator, .csg = csg_});
        built.seconds = clock.seconds();
    });
    return built;
}

ReplayFigures SceneTrial::ask(const Scene& scene, const ReplayOptions& options) {
    ReplayFigures figures;
    ThreadLimit(1).run([&] {
        if (answers_.empty() && !stream_.rays.empty()) {
            (void)replay(stream_, *reference_.scene.aggregate, {.repetitions = 0}, answers_);
        }
        figures = replay(stream_, *scene.aggregate, options, answers_);
    });
    return figures;
}

}  // namespace alhazen
