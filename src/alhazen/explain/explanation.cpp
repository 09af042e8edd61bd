#include "alhazen/explain/explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/explain/spans/part_of_primitive.h"
#include "alhazen/explain/tree/ray_tree_recorder.h"
#include "alhazen/imaging/film/finite_mean.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/core/samplers.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/session/lighting.h"

namespace alhazen {

namespace {

/// Limit of the depth of the tree.
constexpr int kMostDepth = 64;
/// Limit of the recorded steps of the accelerator.
constexpr std::size_t kMostSteps = 5'000;

/// The samples of one pixel of a job.
class PixelSamples {
  public:
    PixelSamples(const RenderJob& job, int width, int height, int x, int y)
        : width_(width), height_(height), x_(x), y_(y) {
        if (job.samples_per_pixel == 1) {
            list(PointSampler(job, width, height));
        } else {
            list(JitteredSampler(job, width, height));
        }
        const EyeRays eye(job.camera);
        for (const Vec2& p : film_) rays_.push_back(eye.ray(eye.column(p.x) + eye.row(p.y)));
    }

    [[nodiscard]] std::span<const Ray> rays() const { return rays_; }
    /// Position of a sample in the pixel.
    [[nodiscard]] Vec2 place(std::size_t i) const {
        return {film_[i].x * width_ - x_, (1.0 - film_[i].y) * height_ - y_};
    }

  private:
    template <PixelSampler Sampler>
    void list(const Sampler& sampler) {
        for (int s = 0; s < sampler.count(); ++s) film_.push_back(sampler.at(x_, y_, s));
    }

    int width_, height_, x_, y_;
    std::vector<Vec2> film_;  ///< positions on the film
    std::vector<Ray> rays_;
};

void check(const LoadedScene& loaded, const ExplainOptions& options, const FrameSize& frame) {
    const auto need = [](bool ok, const std::string& message) {
        if (!ok) throw Error(ErrorKind::Usage, message);
    };
    need(loaded.scene.aggregate != nullptr, "an explanation needs the aggregate of the scene");
    need(options.x >= 0 && options.x < frame.width && options.y >= 0 && options.y < frame.height,
         fmt::format("pixel {},{} is not in a picture of {}x{}", options.x, options.y, frame.width,
                     frame.height));
    const int samples = options.render.samples_per_pixel;
    need(samples >= 1 && samples <= 4096,
         fmt::format("samples per pixel must be 1 to 4096, found {}", samples));
    need(options.sample >= 0 && options.sample < samples,
         fmt::format("sample {}: the pixel has {}, counted from 0", options.sample, samples));
}

/// True if a ray of the tree was not sent because of the depth.
bool ends_by_depth(const RayNode& ray) {
    const auto one_does = [](const std::vector<RayNode>& rays) {
        return std::any_of(rays.begin(), rays.end(), ends_by_depth);
    };
    return std::any_of(ray.surfaces.begin(), ray.surfaces.end(), [&](const SurfaceNode& s) {
        return s.no_reflected == NotSent::Deepest || s.no_refracted == NotSent::Deepest ||
               one_does(s.reflected) || one_does(s.refracted);
    });
}

/// Traces the tree of a ray; false if it has too many rays, or after a stop.
bool trace_tree(RenderJob job, std::span<const Ray> ray, std::size_t most, RayNode& tree) {
    StopFlag enough;
    const StopFlag* const stop = std::exchange(job.control.stop, &enough);
    RayCounters counters;
    RecursiveEstimator<RayTreeRecorder> estimator(job, 1, counters);
    estimator.randomness().limit(most, enough, stop);
    Rgb radiance;
    estimator.trace(ray, {&radiance, 1});
    if (enough.requested()) return false;
    std::vector<RayNode> trees = estimator.randomness().take();
    tree = std::move(trees.front());
    return true;
}

/// Traces the deepest tree within the limits. `depth` is that of the job's scene on input, and that
/// of the tree on output.
void trace_deepest(const RenderJob& job, std::span<const Ray> ray, const ExplainOptions& options,
                   int& depth, Explanation& e) {
    const int wished = depth;
    depth = std::min(wished, kMostDepth);
    if (trace_tree(job, ray, options.most_rays, e.tree)) {
        if (!ends_by_depth(e.tree)) depth = wished;
        return;
    }
    int fits = 0, too_deep = depth;  // the first surfaces are always shown
    depth = 0;
    (void)trace_tree(job, ray, std::numeric_limits<std::size_t>::max(), e.tree);
    while (fits + 1 < too_deep && !job.stop_requested()) {
        depth = fits + (too_deep - fits) / 2;
        RayNode tree;
        if (trace_tree(job, ray, options.most_rays, tree)) {
            e.tree = std::move(tree);
            fits = depth;
        } else {
            too_deep = depth;
        }
    }
    depth = fits;
}

/// Traces the tree of one sample, and the radiance of all. `depth`: as in trace_deepest.
void trace_samples(const RenderJob& job, const PixelSamples& samples, const ExplainOptions& options,
                   int& depth, Explanation& e) {
    const auto chosen = static_cast<std::size_t>(e.sample);
    e.wished_depth = depth;
    trace_deepest(job, samples.rays().subspan(chosen, 1), options, depth, e);
    e.max_depth = depth;
    RayCounters counters;
    RecursiveEstimator<NoRandomness> estimator(job, 1, counters);
    FiniteMean mean;
    for (std::size_t i = 0; i < samples.rays().size() && !job.stop_requested(); ++i) {
        Rgb radiance;
        if (i == chosen) {
            radiance = e.tree.radiance;
        } else {
            estimator.trace(samples.rays().subspan(i, 1), {&radiance, 1});
        }
        mean.add(radiance);
        e.samples.push_back({samples.place(i), radiance});
    }
    e.pixel = mean.value();
}

AcceleratorWork work_of(const std::string& accelerator, const Scene& scene, const Ray& ray) {
    AcceleratorWork work;
    work.accelerator = accelerator;
    Hit hit;
    try {
        const auto aggregate = make_aggregate(accelerator, scene.aggregate->primitives());
        (void)aggregate->closest(ray, hit, {&work.stats, mask_of(RayKind::Eye)});
    } catch (const Error& error) {
        work.unavailable = error.what();
    }
    work.t = hit.t;
    return work;
}

/// Records the steps of the chosen accelerator, and the work of it, `list` and `wide_bvh`.
void trace_accelerators(const LoadedScene& loaded, const ExplainOptions& options, const Ray& ray,
                        Explanation& e) {
    const std::string& accelerator = options.accelerator;
    const StopFlag* const stop = options.render.stop;
    const auto stopped = [&] { return stop != nullptr && stop->requested(); };
    if (accelerator.empty() || stopped()) return;
    const PrimitiveTable& table = loaded.scene.aggregate->primitives();
    e.traversal = trace_traversal(loaded.scene, accelerator, ray);
    std::vector<TraversalStep>& steps = e.traversal.steps;
    if (steps.size() > kMostSteps) {
        e.steps_left_out = steps.size() - kMostSteps;
        steps.resize(kMostSteps);
    }
    for (const TraversalStep& step : steps) {
        e.candidates.push_back(
            step.kind == TraversalStep::Kind::Primitive
                ? part_name(loaded.description, part_of_primitive(table, PrimitiveId{step.number}))
                : "");
    }
    for (const std::string& name : {accelerator, std::string("list"), std::string("wide_bvh")}) {
        const auto has = [&](const AcceleratorWork& w) { return w.accelerator == name; };
        if (stopped() || std::any_of(e.work.begin(), e.work.end(), has)) continue;
        e.work.push_back(work_of(name, loaded.scene, ray));
    }
}

void name_part(std::uint32_t part, const SceneDescription& description, Explanation& e) {
    if (e.part_names.size() <= part) e.part_names.resize(part + 1);
    if (e.part_names[part].empty()) e.part_names[part] = part_name(description, part);
}

void name_parts_of(const RayNode& ray, const SceneDescription& description, Explanation& e) {
    const auto name = [&](std::uint32_t part) { name_part(part, description, e); };
    for (const SurfaceNode& surface : ray.surfaces) {
        name(surface.part);
        for (const LightTerm& light : surface.lights) {
            for (const LightTerm::Crossing& crossing : light.crossings) name(crossing.part);
        }
        for (const RayNode& child : surface.reflected) name_parts_of(child, description, e);
        for (const RayNode& child : surface.refracted) name_parts_of(child, description, e);
    }
}

/// Adds the path of a sample, which is the one of the whole picture.
void add_path(const Scene& scene, const SceneDescription& description,
              const ExplainOptions& options, Explanation& e) {
    RenderOptions one = options.render;
    one.crop = PixelBox{e.x, e.y, e.x + 1, e.y + 1};
    one.aovs = AovSet();
    one.antialias.reset();
    PathRecord record;
    record.sample = static_cast<std::uint32_t>(e.sample);
    one.path = &record;
    if (!render_with_description(scene, description, one).complete) return;
    if (!record.vertices.empty()) e.path = std::move(record);
}

/// Adds a small picture, and the positions of its pixels in space.
void add_picture(const Scene& scene, const SceneDescription& description,
                 const ExplainOptions& options, Explanation& e) {
    constexpr int kLongestSide = 240;
    constexpr int kDepthOfPicture = 5;  // enough to show where things are
    const double scale =
        std::min(1.0, static_cast<double>(kLongestSide) / std::max(e.width, e.height));
    RenderOptions small = options.render;
    small.renderer = "whitted";
    small.width = std::max(1, static_cast<int>(std::lround(e.width * scale)));
    small.height = std::max(1, static_cast<int>(std::lround(e.height * scale)));
    small.samples_per_pixel = 1;
    small.max_depth = std::min(e.max_depth, kDepthOfPicture);
    small.aovs = AovSet();
    small.aovs.add(AovKind::Position);
    small.aovs.add(AovKind::Alpha);
    const RenderResult result = render_with_description(scene, description, small);
    e.complete &= result.complete;
    e.preview = encode(result.film.data(), *small.width, *small.height, Encoding::Srgb, 8);
    const LayerChannel* channels[] = {result.layers.find("P.X"), result.layers.find("P.Y"),
                                      result.layers.find("P.Z"), result.layers.find("A")};
    for (const LayerChannel* channel : channels) {
        if (channel == nullptr) return;
    }
    constexpr int kEvery = 3;  // pixels per point
    for (int y = 1; y < *small.height; y += kEvery) {
        for (int x = 1; x < *small.width; x += kEvery) {
            const auto i = static_cast<std::size_t>(y * *small.width + x);
            if (!(channels[3]->values[i] > 0.0f)) continue;
            e.points.push_back(
                {{channels[0]->values[i], channels[1]->values[i], channels[2]->values[i]},
                 result.film.at(x, y)});
        }
    }
}

}  // namespace

Explanation explain_pixel(const LoadedScene& loaded, const ExplainOptions& options) {
    Scene scene = options.scene != nullptr ? *options.scene : loaded.scene;
    if (options.render.max_depth) scene.conventions.shading.max_depth = *options.render.max_depth;
    const CameraDescription& described = chosen_camera(scene, options.render);
    const FrameSize frame =
        frame_size(loaded.description.picture, options.render, described.aspect);
    check(loaded, options, frame);
    const RenderJob job{
        .scene = scene,
        .camera = with_aspect(described.camera, described.aspect,
                              static_cast<double>(frame.width) / frame.height),
        .samples_per_pixel = options.render.samples_per_pixel,
        .seed = options.render.seed,
        .cone = eye_cone(described.camera, frame.height, options.render.samples_per_pixel),
        .description = &loaded.description,
        .control = {.threads = options.render.threads, .stop = options.render.stop}};

    Explanation e;
    e.width = frame.width;
    e.height = frame.height;
    e.x = options.x;
    e.y = options.y;
    e.sample = options.sample;
    e.scene = loaded.description.path.filename().string();
    e.camera = described.name;
    e.renderer = options.render.renderer.substr(0, options.render.renderer.find(':'));
    e.draws_at_random = make_renderer(options.render.renderer)->distributes();
    e.min_contribution = scene.conventions.shading.min_contribution;
    e.background = scene.background;
    const PixelSamples samples(job, frame.width, frame.height, options.x, options.y);
    trace_samples(job, samples, options, scene.conventions.shading.max_depth, e);
    const Ray& ray = samples.rays()[static_cast<std::size_t>(options.sample)];
    e.spans = solid_spans(loaded, ray);
    e.polynomials = polynomials_on_ray(loaded, ray);
    e.patches = patch_subdivisions(loaded, ray);
    trace_accelerators(loaded, options, ray, e);
    if (options.render.renderer == "cone_tracing")
        e.cones = explain_cones(job, e.x, e.y, e.width, e.height);
    if (options.render.renderer == "beam_tracing")
        e.beams = explain_beams(job, e.x, e.y, e.width, e.height);
    if (e.renderer == "path_tracing") add_path(scene, loaded.description, options, e);
    e.complete = !job.stop_requested();
    if (!e.complete) return e;
    name_parts_of(e.tree, loaded.description, e);
    if (e.path) {
        for (const RecordedVertex& v : e.path->vertices) {
            if (v.has_surface) name_part(v.part, loaded.description, e);
        }
    }
    for (const Material& material : scene.materials) e.material_names.push_back(material.name);
    for (std::size_t i = 0; i < loaded.description.lights.size(); ++i) {
        e.light_names.push_back(light_name(loaded.description, i));
    }
    e.parallel = std::holds_alternative<OrthographicCamera>(job.camera);
    const Vec2 corners[] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    for (std::size_t i = 0; i < 4; ++i) {
        const Ray corner = eye_ray(job.camera, corners[i].x, corners[i].y);
        e.picture[i] = e.parallel ? corner.origin : corner.at(1.0);
    }
    if (options.with_picture) add_picture(scene, loaded.description, options, e);
    return e;
}

}  // namespace alhazen
