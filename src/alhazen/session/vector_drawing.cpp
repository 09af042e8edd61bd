#include "alhazen/session/vector_drawing.h"

#include <fmt/format.h>

#include <algorithm>

#include "alhazen/imaging/image/encoding.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/beam_tracing/beam_drawing.h"
#include "alhazen/session/aov_pictures.h"

namespace alhazen {

namespace {

/// Limits that keep the time of a drawing to seconds: about the number of tests of hulls, from
/// which on mirrors and panes show nothing, and that of the lit parts of a piece for each light,
/// from which on shadows of transparent facets divide no further.
constexpr std::uint64_t kMostDrawingTests = 60'000'000;
constexpr std::size_t kMostDrawnParts = 4096;

}  // namespace

Drawing draw_scene(const LoadedScene& loaded, const RenderOptions& options, DrawingLook look) {
    Scene scene = loaded.scene;
    if (options.max_depth) scene.conventions.shading.max_depth = *options.max_depth;
    const CameraDescription& camera = find_camera(scene, options.camera);
    const FrameSize frame = frame_size(loaded.description.picture, options, camera.aspect);
    const double aspect = static_cast<double>(frame.width) / frame.height;
    const RenderJob job{.scene = scene,
                        .camera = with_aspect(camera.camera, camera.aspect, aspect),
                        .description = &loaded.description,
                        .control = {.threads = options.threads, .stop = options.stop}};
    BeamDrawingOptions drawing{.width = frame.width,
                               .height = frame.height,
                               .shaded = look != DrawingLook::Technical,
                               .lines = look != DrawingLook::Shaded};
    drawing.name_of = [&](std::uint32_t part) { return part_name(loaded.description, part); };
    const auto limit = static_cast<std::int32_t>(kBeamFilm);
    const PolygonSet window = lattice_rectangle({-limit, -limit}, {limit, limit});
    Drawing result;
    ThreadLimit(options.threads).run([&] {
        const BeamScene facets = beam_scene(loaded.description, scene);
        const BeamTree tree =
            beam_tree(job, facets, window,
                      {.cast = {.most_parts = kMostDrawnParts}, .most_tests = kMostDrawingTests});
        result = beam_drawing(job, facets, tree, drawing);
        result.notes = facets.notes;
        if (tree.left_out > 0) {
            result.notes.push_back(
                fmt::format("{} of the smallest mirror images and views through transparent facets "
                            "are left out, with what is behind them",
                            tree.left_out));
        }
    });
    const bool linear = scene.conventions.film.linear_output;
    for (int k = 0; k < 3; ++k) {
        const double c = std::clamp(scene.background[k], 0.0, 1.0);
        result.background[k] = look == DrawingLook::Technical ? 1.0
                               : linear                       ? c
                                                              : srgb_from_linear(c);
    }
    return result;
}

}  // namespace alhazen
