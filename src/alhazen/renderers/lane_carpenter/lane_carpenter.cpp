#include "alhazen/renderers/lane_carpenter/lane_carpenter.h"

#include <memory>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/lane_carpenter/crack_count.h"
#include "alhazen/renderers/lane_carpenter/scan_shading.h"

namespace alhazen {

namespace {

/// Number of scan lines shaded in parallel.
constexpr int kLinesAtOnce = 32;
constexpr int kLinesOfBlock = 4;
/// Least flatness, in pixels, that is tried.
constexpr double kLeastFlatness = 0x1p-14;

Vec3 eye_of(const Camera& camera) {
    return picture_plane(camera).eye;
}

/// Halves the flatness until no sample lies in a crack.
void tighten(const ScanScene& scene, const ScreenView& view, const SampleGrid& grid,
             const RenderJob& job, ScanLineOptions& options, ScanLineReport& counts) {
    counts.counted_cracks = true;
    while (true) {
        counts.crack_samples = count_crack_samples(scene, view, grid, options);
        if (counts.crack_samples == 0 || options.flatness <= kLeastFlatness ||
            options.cracks != Cracks::Tighter || job.stop_requested()) {
            return;
        }
        options.flatness *= 0.5;
        ++counts.passes;
    }
}

/// Clears the layers of ray counts and times, as no rays are traced.
void clear_costs(const RenderJob& job, const PixelBox& crop) {
    if (job.aovs == nullptr || !job.aovs->wanted().has_costs()) return;
    constexpr double kNone = 0.0;
    for (int y = crop.y0; y < crop.y1; ++y) {
        for (int x = crop.x0; x < crop.x1; ++x) {
            for (const AovKind kind : {AovKind::Rays, AovKind::NodeVisits, AovKind::BoxTests,
                                       AovKind::PrimitiveTests, AovKind::Time}) {
                job.aovs->set(kind, x, y, {&kNone, 1});
            }
        }
    }
}

}  // namespace

RenderReport LaneCarpenter::render(const RenderJob& job, Film& film) const {
    if (job.description == nullptr) {
        throw Error(ErrorKind::Usage, "scan lines need the description of the scene");
    }
    const ScanScene scene = scan_scene(*job.description, job.scene, eye_of(job.camera));
    const ScreenView view(job.camera, film.frame_width(), film.frame_height(), scene.farthest);
    const SampleGrid grid(job, film, view);
    ScanLineOptions options = options_;
    ScanLineReport cracks;
    const bool finds = options.cracks == Cracks::Tighter ||
                       (options.find_cracks && options.cracks == Cracks::Show);
    if (finds && !grid.several()) {
        // The tolerance does not depend on the crop.
        const PixelBox whole{0, 0, film.frame_width(), film.frame_height()};
        const bool tightens = options.cracks == Cracks::Tighter;
        tighten(scene, view, SampleGrid(job, film, tightens ? whole : film.crop(), view), job,
                options, cracks);
    }
    ScanLines lines(scene, view, grid, options);
    clear_costs(job, film.crop());
    RenderReport report;
    report.parts = static_cast<std::size_t>(grid.rows());
    ThreadLimit threads(job.control.threads);
    report.threads = threads.threads();
    std::vector<ScanRow> rows(kLinesAtOnce);
    std::vector<std::uint64_t> left_out(report.parts);
    // One for each block of lines.
    std::vector<std::unique_ptr<ScanShading>> shadings(kLinesAtOnce / kLinesOfBlock);
    for (int first = 0; first < grid.rows() && !job.stop_requested(); first += kLinesAtOnce) {
        const int count = std::min(kLinesAtOnce, grid.rows() - first);
        for (int k = 0; k < count; ++k) lines.next(rows[static_cast<std::size_t>(k)]);
        threads.run([&] {
            const auto blocks = static_cast<std::size_t>(count + kLinesOfBlock - 1) / kLinesOfBlock;
            parallel_for(blocks, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t block = begin; block < end; ++block) {
                    auto& shading = shadings[block];
                    if (shading == nullptr) {
                        shading =
                            std::make_unique<ScanShading>(job, scene, view, grid, options.flatness);
                    }
                    const int from = static_cast<int>(block) * kLinesOfBlock;
                    for (int k = from; k < std::min(from + kLinesOfBlock, count); ++k) {
                        left_out[static_cast<std::size_t>(first + k)] =
                            shading->shade(rows[static_cast<std::size_t>(k)], first + k, film);
                    }
                }
            });
        });
        report.done += static_cast<std::size_t>(count);
        if (job.control.progress != nullptr) {
            job.control.progress->update("render", report.done, report.parts);
        }
    }
    for (const std::uint64_t n : left_out) report.counters.non_finite += n;
    auto counts = std::make_shared<ScanLineReport>(std::move(lines.report()));
    counts->passes = cracks.passes;
    counts->crack_samples = cracks.crack_samples;
    counts->counted_cracks = cracks.counted_cracks;
    report.scan_lines = std::move(counts);
    return report;
}

}  // namespace alhazen
