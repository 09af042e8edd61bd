/// The part of path tracing that is ray queries: the rays of a picture (eye, bounce and shadow)
/// traced by the batch kernels alone, compared with the whole renderer.
/// Usage: alhazen_path_bench SCENE... [--size WxH] [--spp N] [--depth N] [--rounds N]
///            [--markdown FILE]
/// A first picture records every batch. Then both take turns on one thread, round after round: the
/// batches in their order, with only queries timed, and the picture, whose lights are prepared
/// before the clock starts. Rates are medians; shares are quotients of the two times of a round.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "alhazen/base/file.h"
#include "alhazen/cameras/camera.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/laboratory/ray_stream.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/path_tracing/path_tracing.h"
#include "alhazen/session/load.h"
#include "command_line.h"
#include "measure.h"

namespace {

using namespace alhazen;
using namespace alhazen::bench;

struct Plan {
    int width = 120, height = 90;
    int samples = 16;
    int rounds = 7;
    PathSettings paths;
};

/// Repeats the queries of a recorded stream.
class BareKernels {
  public:
    BareKernels(const RayStream& stream, const Aggregate& asked) : stream_(stream), asked_(asked) {
        std::size_t most = 0;
        for (const RayBatch& batch : stream.batches) most = std::max(most, batch.count);
        hits_.resize(most);
        met_ = std::make_unique<bool[]>(most);
    }

    /// Repeats the queries; returns the number of rays that hit.
    std::size_t ask() {
        std::size_t hits = 0;
        for (const RayBatch& batch : stream_.batches) {
            const std::span rays(&stream_.rays[batch.first], batch.count);
            const RayQuery query{nullptr, mask_of(batch.kind)};
            if (batch.question == RayQuestion::Closest) {
                const std::span found = std::span(hits_).first(batch.count);
                asked_.closest_batch(rays, found, query, batch.coherence);
                for (const Hit& hit : found) hits += hit.found();
            } else {
                const std::span met(met_.get(), batch.count);
                asked_.occluded_batch(rays, met, query, batch.coherence);
                for (const bool one : met) hits += one;
            }
        }
        return hits;
    }

  private:
    const RayStream& stream_;
    const Aggregate& asked_;
    std::vector<Hit> hits_;
    std::unique_ptr<bool[]> met_;
};

/// Renders a picture with one thread; returns its number of rays.
std::size_t render_picture(const Scene& scene, const Illumination& lights, const Plan& plan) {
    const CameraDescription& camera = find_camera(scene, "");
    const double aspect = static_cast<double>(plan.width) / plan.height;
    Film film(plan.width, plan.height, PixelBox{0, 0, plan.width, plan.height});
    const RenderJob job{.scene = scene,
                        .camera = with_aspect(camera.camera, camera.aspect, aspect),
                        .samples_per_pixel = plan.samples,
                        .cone = eye_cone(camera.camera, plan.height, plan.samples),
                        .control = {.threads = 1}};
    const RenderReport report = trace_paths(job, lights, plan.paths, film);
    std::size_t rays = 0;
    for (const RayCount& kind : report.counters.rays) rays += kind.cast;
    return rays;
}

std::string row_of(const std::string& name, const Plan& plan) {
    const LoadedScene loaded = load(name, {.threads = 1});
    const Scene& scene = loaded.scene;
    const Illumination lights(scene);
    RayStream stream;
    stream.most = std::size_t(1) << 32;
    Scene recording = scene;
    recording.aggregate = std::make_shared<const RayRecorder>(*scene.aggregate, stream);
    const std::size_t rays = render_picture(recording, lights, plan);
    if (stream.rays.size() != rays) {
        throw Error(ErrorKind::Render, fmt::format("{}: {} rays were cast, {} recorded", name, rays,
                                                   stream.rays.size()));
    }
    std::size_t eye = 0, shadow = 0;
    for (const RayBatch& batch : stream.batches) {
        if (batch.question != RayQuestion::Closest)
            shadow += batch.count;
        else if (batch.coherence == Coherence::Coherent)
            eye += batch.count;
    }
    BareKernels kernels(stream, *scene.aggregate);
    std::vector<double> whole, bare, shares;
    for (int round = 0; round <= plan.rounds; ++round) {
        const double begin = processor_seconds();
        (void)kernels.ask();
        const double middle = processor_seconds();
        (void)render_picture(scene, lights, plan);
        const double end = processor_seconds();
        if (round == 0) continue;  // warms the caches
        bare.push_back(1e-6 * static_cast<double>(rays) / (middle - begin));
        whole.push_back(1e-6 * static_cast<double>(rays) / (end - middle));
        shares.push_back((middle - begin) / (end - middle));
    }
    const Spread share = spread_of(shares);
    const auto percent = [&](std::size_t n) { return 100.0 * double(n) / double(rays); };
    const std::string stem = std::filesystem::path(name).stem().string();
    return fmt::format(
        "| {} | {:.2f} | {:.0f}, {:.0f}, {:.0f} | {:.2f} | {:.2f} | {:.3f} | {:.3f} to {:.3f} |\n",
        stem, 1e-6 * double(rays), percent(eye), percent(rays - eye - shadow), percent(shadow),
        spread_of(whole).median, spread_of(bare).median, share.median, share.lower, share.upper);
}

int run(int argc, char** argv) {
    const CommandLine line(argc, argv, {"--size", "--spp", "--depth", "--rounds", "--markdown"});
    if (line.rest.empty()) throw Error(ErrorKind::Usage, "name a scene");
    Plan plan;
    const std::string size = line.text("--size", "120x90");
    if (std::sscanf(size.c_str(), "%dx%d", &plan.width, &plan.height) != 2 || plan.width < 1 ||
        plan.height < 1) {
        throw Error(ErrorKind::Usage, "--size is " + size + ", expected WIDTHxHEIGHT");
    }
    plan.samples = static_cast<int>(line.count("--spp", 16));
    plan.paths.depth = static_cast<int>(line.count("--depth", 9));
    plan.rounds = static_cast<int>(line.count("--rounds", 7));
    std::string table = fmt::format(
        "{}x{}, {} samples, {} scatterings, {} rounds\n\n"
        "| scene | M rays | eye, bounce, shadow, % | path tracing, M rays/s | kernels alone | "
        "share "
        "| quartiles |\n|---|---|---|---|---|---|---|\n",
        plan.width, plan.height, plan.samples, plan.paths.depth, plan.rounds);
    fmt::print("{}", table);
    for (const std::string& scene : line.rest) {
        ThreadLimit(1).run([&] {
            const std::string row = row_of(scene, plan);
            fmt::print("{}", row);
            std::fflush(stdout);
            table += row;
        });
    }
    if (line.has("--markdown")) write_file_atomically(line.text("--markdown", ""), table);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    }
}
