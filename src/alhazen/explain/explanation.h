#pragma once
/// Why a pixel has its colour: everything that the renderer `whitted` does for one sample of it, as
/// data.
///
/// Conventions: pixels count from the top left. The tree is that of `sample`; spans, polynomials
/// and traversal are those of its eye ray. Accelerators are built over the outermost primitives of
/// the scene, as in laboratory/traversal_trace.h; nothing moves: rays are those as the shutter
/// opens. A tree of too many rays is that of a smaller depth, which all samples then have. After a
/// stop the explanation is not complete. Complexity: builds one accelerator for the steps, and one
/// for each line of `counts`.

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
    int sample = 0;  ///< of those of the pixel
    /// Whose steps are shown: one of `traceable_accelerators()`, with settings. Empty: none.
    std::string accelerator = "kay_kajiya";
    /// Camera, size, samples per pixel, depth, seed, threads and stop are read. The tree is that of
    /// `whitted`; with the renderers `cone_tracing`, `beam_tracing` and `path_tracing` (without
    /// `manifold` and `polarization`) there are cones, beams, or a path.
    RenderOptions render;
    /// Instead of that of the file, whose geometry it has (session/lighting.h); null: none.
    const Scene* scene = nullptr;
    std::size_t most_rays = 10'000;  ///< of the tree, shadow rays included
    int most_depth = 64;             ///< of the tree
    std::size_t most_steps = 5'000;  ///< of the accelerator
    bool with_picture = true;        ///< a small picture, and points of the scene around the rays
};

struct PixelSample {
    Vec2 place;  ///< in the pixel, (0, 0) its upper left corner, (1, 1) the lower right one
    Rgb radiance;
};

/// The work of an accelerator for the eye ray.
struct AcceleratorWork {
    std::string accelerator;
    std::string unavailable;  ///< why it could not be built
    TraversalStats stats;
    double t = 0;  ///< of the hit; infinite without
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
    bool draws_at_random = false;  ///< it does
    int max_depth = 0;             ///< of the tree
    int wished_depth = 0;          ///< larger where the tree was cut
    double min_contribution = 0;
    Rgb background;
    Rgb pixel;  ///< the mean of the samples
    std::vector<PixelSample> samples;
    RayNode tree;
    Vec3 picture[4];  ///< corners of the picture around the eye rays, from the upper left clockwise
    bool parallel = false;  ///< the eye rays are: `picture` is where they start
    std::vector<SolidSpans> spans;
    std::vector<PolynomialOnRay> polynomials;
    std::vector<PatchSubdivision> patches;
    TraversalTrace traversal;
    std::size_t steps_left_out = 0;
    std::vector<std::string> candidates;      ///< [step of `traversal`] name of its primitive
    std::vector<AcceleratorWork> work;        ///< of the chosen one, `list` and `wide_bvh`
    std::vector<std::string> part_names;      ///< [Surface::part] of the tree; others empty
    std::vector<std::string> material_names;  ///< [material]
    std::vector<std::string> light_names;     ///< [light]
    std::optional<ConeExplanation> cones;
    std::optional<BeamExplanation> beams;
    std::optional<PathRecord> path;  ///< of `sample`, by the renderer `path_tracing`
    EncodedImage preview;
    std::vector<ScenePoint> points;
};

/// Throws Error (Usage) for a pixel, a sample or an accelerator that there is not. The scene must
/// have its aggregate and a camera.
[[nodiscard]] Explanation explain_pixel(const LoadedScene& loaded, const ExplainOptions& options);

}  // namespace alhazen
