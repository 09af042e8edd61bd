#pragma once
/// Progressive rendering: the mean over passes, each with its own photons and one sample per pixel.
///
/// Source: Hachisuka and Jensen, "Stochastic Progressive Photon Mapping", SIGGRAPH Asia 2009;
/// Knaus and Zwicker, "Progressive Photon Mapping: A Probabilistic Approach", ACM TOG 30(3), 2011
/// (radii of the passes).

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/renderers/core/reports/sampling_report.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// Squared radius of pass i + 1 over that of pass i = 1, 2, ...
[[nodiscard]] inline double squared_radius_step(double alpha, int pass) {
    return (pass + alpha) / (pass + 1.0);
}

/// Three times the median width of a pixel at the visible surfaces.
[[nodiscard]] double radius_of_pixels(const RenderJob& job, const Film& film);

/// RGB channels, or, for spectral jobs, the wavelengths of all paths of pass (or set) `number`:
/// stratified over successive passes, each uniform over seeds.
[[nodiscard]] Wavelengths waves_of_pass(const RenderJob& job, std::uint32_t number);

/// The part of the shutter interval of all paths of pass `number`, photons and eye paths, if
/// something moves. Passes 2^k to 2^(k + 1) - 1 have the 2^k equal parts in van der Corput order:
/// the parts shrink, and successive passes are evenly distributed.
[[nodiscard]] ShutterPart shutter_of_pass(const RenderJob& job, std::uint32_t number);

/// Throws Error (Usage) if the job has a stop rule instead of a number of samples. `renderer`: name
/// for messages.
void refuse_stop_rules(const RenderJob& job, const char* renderer);

class PhotonPasses {
  public:
    /// Throws for stop rules.
    PhotonPasses(const RenderJob& job, Film& film, const char* renderer);
    ~PhotonPasses();
    PhotonPasses(const PhotonPasses&) = delete;
    PhotonPasses& operator=(const PhotonPasses&) = delete;

    /// The job, with progress reported as one task.
    [[nodiscard]] const RenderJob& job() const { return job_; }
    [[nodiscard]] std::uint32_t count() const { return count_; }
    [[nodiscard]] RenderReport& report() { return report_; }

    /// The eye part of the next pass: adds a sample to each pixel. `begin(job)` makes the
    /// TileRenderer of one thread. False after a stop. The first pass writes the job's layers.
    using Begin = std::function<std::unique_ptr<TileRenderer>(const RenderJob& job)>;
    bool look(const Begin& begin);
    /// The report of a stop before `look`.
    [[nodiscard]] RenderReport& stopped();

  private:
    class Progress;

    RenderJob job_;
    Film& film_;
    std::uint32_t count_, done_ = 0;
    std::unique_ptr<Progress> progress_;
    std::unique_ptr<Sampler> sampler_;
    FilterKernel filter_;
    std::vector<SampleSum> sums_;
    std::shared_ptr<SamplingReport> sampling_;
    RenderReport report_;
};

}  // namespace alhazen
