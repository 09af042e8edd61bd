#pragma once
/// Explains the colour of a pixel: everything that the renderer `whitted` does for one sample of
/// it, as data.
///
/// Conventions: pixels count from the top left. The tree belongs to `sample`; spans, polynomials
/// and traversal belong to its eye ray. Accelerators are built over the outermost primitives of the
/// scene, as in laboratory/traversal_trace.h. Nothing moves: all rays are at the time the shutter
/// opens. If a tree has too many rays, the depth is reduced for all samples. After a stop the
/// explanation is incomplete.
/// Complexity: builds one accelerator for the steps, and one for each entry of `work`.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/explain/beams/beam_explanation.h"
#include "alhazen/explain/cones/cone_explanation.h"
#include "alhazen/explain/patches/patch_subdivision.h"
#include "alhazen/explain/spans/polynomials_on_ray.h"
#include "alhazen/explain/spans/ray_spans.h"
#include "alhazen/explain/tree/ray_tree.h"
#include "alhazen/imaging/image/encoding.h"
#include "alhazen/laboratory/traversal_trace.h"
#include "alhazen/renderers/core/path_record.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"

namespace alhazen {

struct ExplainOptions {
    int x = 0, y = 0;
    int sample = 0;  ///< index among the samples of the pixel
    /// Accelerator whose steps are recorded: one of `traceable_accelerators()`, with settings.
    /// Empty: none.
    std::string accelerator = "kay_kajiya";
    /// Used are camera, size, samples per pixel, depth, seed, threads and stop. The tree is that of
    /// `whitted`; the renderers `cone_tracing`, `beam_tracing` and `path_tracing` (without
    /// `manifold` and `polarization`) add cones, beams, or a path.
    RenderOptions render;
    /// Replaces the scene of the file, with the same geometry (session/lighting.h); null: none.
    const Scene* scene = nullptr;
    std::size_t most_rays = 10'000;  ///< limit of the tree, shadow rays included
    bool with_picture = true;        ///< adds a small picture, and scene points around the rays
};

struct PixelSample {
    Vec2 place;  ///< position in the pixel: (0, 0) upper left, (1, 1) lower right
    Rgb radiance;
};

/// Work of an accelerator for the eye ray.
struct AcceleratorWork {
    std::string accelerator;
    std::string unavailable;  ///< reason if it could not be built; else empty
    TraversalStats stats;
    double t = 0;  ///< of the hit; infinite without a hit
};

/// A point of the scene that the camera sees.
struct ScenePoint {
    Vec3 point;
    Rgb color;
};

struct Explanation {
    bool complete = true;  ///< false after a stop
    int width = 0, height = 0, x = 0, y = 0, sample = 0;
    std::string scene, camera;
    std::string renderer;          ///< of the picture, without settings
    bool draws_at_random = false;  ///< true if the renderer is stochastic
    int max_depth = 0;             ///< of the tree
    int wished_depth = 0;  ///< requested depth; larger than max_depth if the tree was reduced
    double min_contribution = 0;
    Rgb background;
    Rgb pixel;  ///< mean of the samples
    std::vector<PixelSample> samples;
    RayNode tree;
    Vec3 picture[4];  ///< corners of the picture around the eye rays, clockwise from the upper left
    bool parallel = false;  ///< eye rays are parallel and start in `picture`
    std::vector<SolidSpans> spans;
    std::vector<PolynomialOnRay> polynomials;
    std::vector<PatchSubdivision> patches;
    TraversalTrace traversal;
    std::size_t steps_left_out = 0;
    std::vector<std::string> candidates;      ///< [step of `traversal`] name of its primitive
    std::vector<AcceleratorWork> work;        ///< of the chosen accelerator, `list` and `wide_bvh`
    std::vector<std::string> part_names;      ///< [Surface::part] of the tree; others empty
    std::vector<std::string> material_names;  ///< [material]
    std::vector<std::string> light_names;     ///< [light]
    std::optional<ConeExplanation> cones;
    std::optional<BeamExplanation> beams;
    std::optional<PathRecord> path;  ///< of `sample`, by the renderer `path_tracing`
    EncodedImage preview;
    std::vector<ScenePoint> points;
};

/// Explains a pixel. Throws Error (Usage) for a pixel, a sample or an accelerator that does not
/// exist. The scene must have its aggregate and a camera.
[[nodiscard]] Explanation explain_pixel(const LoadedScene& loaded, const ExplainOptions& options);

}  // namespace alhazen
