#pragma once
/// The loop over the pixels and samples of tiles: sampler and estimator combined at compile time.
///
/// Conventions: eye rays are traced in batches; neighbours in a batch are neighbours in the film.
/// Memory is reused from tile to tile. Threads: used by one thread.

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/imaging/film/finite_mean.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/estimator.h"
#include "alhazen/renderers/core/pixel_order.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/core/samplers.h"
#include "alhazen/renderers/core/tiles.h"

namespace alhazen {

/// Gathers the eye rays of a tile in batches, traces them and puts the means of their radiance into
/// the film.
template <PixelSampler Sampler>
class PixelLoop {
  public:
    /// `at_once`: largest number of samples of a batch.
    PixelLoop(const RenderJob& job, std::size_t at_once, RayCounters& counters)
        : job_(job),
          counters_(counters),
          aovs_(job, counters),
          eye_(job.camera),
          sums_(at_once),
          rays_(at_once),
          radiance_(at_once) {}

    /// Renders the tile with `estimator`. Returns early after a stop, with whole pixels only.
    template <class Estimator>
    void run(const PixelBox& tile, Film& film, Estimator& estimator) {
        begin_tile(tile, film);
        if (is_plain()) return run_plain(film, estimator);
        // The cost of a pixel is known only if its rays are traced separately.
        const bool alone = job_.aovs != nullptr && job_.aovs->wanted().has_costs();
        for (const Pixel& pixel : pixels_) {
            if (job_.aovs != nullptr) aovs_.begin_pixel();
            for (int s = 0; s < sampler_->count(); ++s) {
                sums_[gathered_++] = sum_of(pixel, s);
                if (gathered_ == sums_.size() && !trace(film, estimator)) return;
            }
            if (alone && !trace(film, estimator)) return;
        }
        trace(film, estimator);
    }

  private:
    /// True if every pixel has one sample and no AOVs are recorded.
    [[nodiscard]] bool is_plain() const { return Sampler::kSeparable && job_.aovs == nullptr; }
    /// `run` for `is_plain`.
    template <class Estimator>
    void run_plain(Film& film, Estimator& estimator) {
        std::span<const Pixel> rest = pixels_;
        while (!rest.empty()) {
            const std::span<const Pixel> next = rest.first(std::min(rest.size(), sums_.size()));
            for (const Pixel& pixel : next) sums_.data()[gathered_++] = separable_sum(pixel);
            if (!trace(film, estimator)) return;
            rest = rest.subspan(next.size());
        }
    }

    using Pixel = TilePixel;

    void begin_tile(const PixelBox& tile, const Film& film) {
        sampler_.emplace(job_, film.frame_width(), film.frame_height());
        gathered_ = done_ = 0;
        samples_ = 0;
        mean_ = {};
        if (pixels_.empty() || tile.width() != tile_.width() || tile.height() != tile_.height()) {
            list_pixels_of_tile(tile.width(), tile.height(), pixels_);
        }
        tile_ = tile;
        if constexpr (Sampler::kSeparable) {
            columns_.clear();
            rows_.clear();
            for (int i = tile.x0; i < tile.x1; ++i) {
                columns_.push_back(eye_.column(sampler_->at(i, 0, 0).x));
            }
            for (int j = tile.y0; j < tile.y1; ++j) {
                rows_.push_back(eye_.row(sampler_->at(0, j, 0).y));
            }
        }
    }

    /// The sum of column and row of the eye ray of a pixel's only sample.
    [[nodiscard]] Vec3 separable_sum(const Pixel& pixel) const {
        return columns_.data()[pixel.i] + rows_.data()[pixel.j];
    }
    /// The sum of column and row of the eye ray of sample `s`.
    [[nodiscard]] Vec3 sum_of(const Pixel& pixel, int s) const {
        if constexpr (Sampler::kSeparable) {
            return separable_sum(pixel);
        } else {
            const Vec2 p = sampler_->at(tile_.x0 + pixel.i, tile_.y0 + pixel.j, s);
            return eye_.column(p.x) + eye_.row(p.y);
        }
    }

    /// Traces the gathered rays. False after a stop.
    template <class Estimator>
    bool trace(Film& film, Estimator& estimator) {
        if (job_.stop_requested()) return false;
        eye_.rays(std::span(sums_).first(gathered_), rays_.data());
        const std::span<Rgb> found = std::span(radiance_).first(gathered_);
        std::fill(found.begin(), found.end(), Rgb{});
        estimator.trace(std::span<const Ray>(rays_).first(gathered_), found);
        // A truncated batch is dropped.
        if (job_.stop_requested()) return false;
        if (is_plain()) {
            take_pixels(film, found);
        } else {
            for (const Rgb& c : found) take(film, c);
        }
        gathered_ = 0;
        return true;
    }

    /// As `take`, for `is_plain`.
    void take_pixels(Film& film, std::span<const Rgb> found) {
        const Pixel* pixel = pixels_.data() + done_;
        Rgb* const corner = film.from(tile_.x0, tile_.y0);
        const std::ptrdiff_t stride = film.crop().width();
        std::uint64_t left_out = 0;
        for (const Rgb& c : found) {
            FiniteMean mean;
            left_out += !mean.add(c);
            corner[pixel->j * stride + pixel->i] = mean.value();
            ++pixel;
        }
        counters_.non_finite += left_out;
        done_ += found.size();
    }

    void take(Film& film, const Rgb& c) {
        counters_.non_finite += !mean_.add(c);
        if (++samples_ == sampler_->count()) end_pixel(film);
    }

    void end_pixel(Film& film) {
        const Pixel& pixel = pixels_[done_++];
        const int i = tile_.x0 + pixel.i, j = tile_.y0 + pixel.j;
        film.set(i, j, mean_.value());
        if (job_.aovs != nullptr) {
            places_.clear();
            for (int s = 0; s < sampler_->count(); ++s) places_.push_back(sampler_->at(i, j, s));
            aovs_.end_pixel(i, j, places_);
        }
        mean_ = {};
        samples_ = 0;
    }

    const RenderJob& job_;
    RayCounters& counters_;
    AovRecorder aovs_;
    EyeRays eye_;
    std::optional<Sampler> sampler_;    ///< of the frame
    std::vector<Vec3> columns_, rows_;  ///< of the tile, where the sampler is separable
    std::vector<Vec3> sums_;            ///< [ray] of a column and a row
    std::size_t gathered_ = 0;          ///< rays
    std::vector<Ray> rays_;
    std::vector<Rgb> radiance_;
    PixelBox tile_;
    std::vector<Pixel> pixels_;  ///< of the tile, in rendering order
    std::size_t done_ = 0;       ///< finished pixels
    int samples_ = 0;            ///< of the current pixel
    FiniteMean mean_;
    std::vector<Vec2> places_;  ///< film coordinates of a pixel's samples
};

/// Returns a RoundRenderer if the job has a round, else that of a PixelLoop with the sampler for
/// the job's samples per pixel.
template <RadianceEstimator Estimator, class... More>
[[nodiscard]] std::unique_ptr<TileRenderer> make_pixel_renderer(const RenderJob& job,
                                                                std::size_t rays_at_once,
                                                                const More&... more) {
    if (job.round != nullptr) {
        return std::make_unique<RoundRenderer<Estimator>>(job, rays_at_once, more...);
    }
    if (job.samples_per_pixel == 1) {
        using Loop = PixelLoop<PointSampler>;
        return std::make_unique<LoopRenderer<Estimator, Loop>>(job, rays_at_once, more...);
    }
    using Loop = PixelLoop<JitteredSampler>;
    return std::make_unique<LoopRenderer<Estimator, Loop>>(job, rays_at_once, more...);
}

}  // namespace alhazen
