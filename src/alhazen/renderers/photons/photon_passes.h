#pragma once
/// Pictures as the mean over passes, each with photons of its own and one sample of each pixel.
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

/// The squared radius of pass i + 1 over that of pass i = 1, 2, ...
[[nodiscard]] inline double squared_radius_step(double alpha, int pass) {
    return (pass + alpha) / (pass + 1.0);
}

/// Three times the median width of a pixel at what the eye sees.
[[nodiscard]] double radius_of_pixels(const RenderJob& job, const Film& film);

/// Channels, or where the job is spectral wavelengths for all paths of pass (or set) `number`:
/// evenly spread over any few of them, each evenly over seeds.
[[nodiscard]] Wavelengths waves_of_pass(const RenderJob& job, std::uint32_t number);

/// In which all paths of pass `number` are, where something moves: photons and who looks at them.
/// Passes 2^k to 2^(k + 1) - 1 have the 2^k parts of the shutter, in an order of van der Corput; so
/// the parts shrink from pass to pass, and any few of them are evenly spread.
[[nodiscard]] ShutterPart shutter_of_pass(const RenderJob& job, std::uint32_t number);

/// Throws Error (Usage) where the job stops by a rule, not after a number of samples. `renderer`:
/// its name.
void refuse_stop_rules(const RenderJob& job, const char* renderer);

class PhotonPasses {
  public:
    /// Refuses rules.
    PhotonPasses(const RenderJob& job, Film& film, const char* renderer);
    ~PhotonPasses();
    PhotonPasses(const PhotonPasses&) = delete;
    PhotonPasses& operator=(const PhotonPasses&) = delete;

    /// Reports progress as one work.
    [[nodiscard]] const RenderJob& job() const { return job_; }
    [[nodiscard]] std::uint32_t count() const { return count_; }
    [[nodiscard]] RenderReport& report() { return report_; }

    /// The eye's part of the next pass: adds a sample to each pixel. `begin(job)` makes the
    /// TileRenderer of one thread. False after a stop. The first pass has the job's layers.
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
