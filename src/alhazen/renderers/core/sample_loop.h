#pragma once
/// The loop over the pixels of a tile for a SamplingPlan: a round of samples for each pixel that
/// is not done.
///
/// Conventions: those of PixelLoop. A pixel has the samples of its sampler in order, independent of
/// the tiles. Threads: used by one thread.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/imaging/film/filter_kernel.h"
#include "alhazen/imaging/film/sample_sum.h"
#include "alhazen/imaging/film/shared_film.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/estimator.h"
#include "alhazen/renderers/core/pixel_order.h"
#include "alhazen/renderers/core/tiles.h"
#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {

/// An interval of the time that the shutter is open (0 to 1).
struct ShutterPart {
    double begin = 0, length = 1;
    /// The time for `u` in [0, 1); below 1 after rounding to float.
    [[nodiscard]] float at(double u) const {
        return std::min(static_cast<float>(begin + length * u), 0x1.fffffep-1f);
    }
};

/// Samples first .. first + count - 1 of all pixels that are not done.
struct SampleRound {
    const Sampler& sampler;
    const FilterKernel& filter;
    std::uint32_t first, count;
    /// [pixel of the crop] 0 where the pixel is done; empty: none is.
    std::span<const std::uint8_t> wanted;
    /// [pixel of the crop] sums of all rounds, which are added to; empty: this is the only round.
    std::span<SampleSum> sums;
    std::uint64_t seed = 0;  ///< of the sampler
    /// Receives each sample for all pixels in reach; `filter` is then the box of one pixel. Null:
    /// samples are not shared.
    SharedFilm* shared = nullptr;
    ShutterPart shutter{};  ///< interval of the times of the samples
    /// Counts the pixels that have got the samples of the round. Null: nobody asks.
    std::atomic<std::uint64_t>* finished = nullptr;
};

class SampleLoop {
  public:
    /// `at_once`: largest number of samples of a batch.
    SampleLoop(const RenderJob& job, std::size_t at_once, RayCounters& counters)
        : job_(job),
          round_(*job.round),
          counters_(counters),
          aovs_(job, counters),
          eye_(job.camera),
          sums_(at_once),
          signs_(at_once),
          ids_(at_once),
          points_(at_once),
          rays_(at_once),
          radiance_(at_once) {
        if (round_.shared != nullptr) {
            offsets_.resize(at_once);
            spread_.emplace(*round_.shared);
        }
    }

    /// Adds the round to the pixels of the tile. After a stop, returns early with whole pixels
    /// only.
    template <class Estimator>
    void run(const PixelBox& tile, Film& film, Estimator& estimator) {
        begin_tile(tile, film);
        // The cost of a pixel is known only if its rays are traced separately.
        const bool alone = job_.aovs != nullptr && job_.aovs->wanted().has_costs();
        for (const TilePixel& pixel : pixels_) {
            if (job_.aovs != nullptr) aovs_.begin_pixel();
            if (!gather(pixel, film, estimator)) return;
            if (alone && !trace(film, estimator)) return;
        }
        trace(film, estimator);
    }

  private:
    [[nodiscard]] std::size_t index(const Film& film, const TilePixel& pixel) const {
        const PixelBox& crop = film.crop();
        return std::size_t(tile_.y0 + pixel.j - crop.y0) * std::size_t(crop.width()) +
               std::size_t(tile_.x0 + pixel.i - crop.x0);
    }

    void begin_tile(const PixelBox& tile, const Film& film) {
        tile_ = tile;
        gathered_ = done_ = 0;
        own_ = {};
        taken_ = 0;
        places_.clear();
        list_pixels_of_tile(tile.width(), tile.height(), pixels_);
        if (round_.wanted.empty()) return;
        std::erase_if(pixels_,
                      [&](const TilePixel& p) { return round_.wanted[index(film, p)] == 0; });
    }

    /// Adds the samples of a pixel to the batch; traces the batch when it is full. False after a
    /// stop.
    template <class Estimator>
    bool gather(const TilePixel& pixel, Film& film, Estimator& estimator) {
        const SamplePixel place{tile_.x0 + pixel.i, tile_.y0 + pixel.j};
        for (std::uint32_t s = 0; s < round_.count;) {
            const auto room = static_cast<std::uint32_t>(sums_.size() - gathered_);
            const std::span<Vec2> some = std::span(points_).first(std::min(room, round_.count - s));
            round_.sampler.points(place, 0, round_.first + s, some);
            for (std::uint32_t n = round_.first + s; const Vec2& u : some) {
                const FilterKernel::Drawn drawn = round_.filter.draw(u);
                if constexpr (SampleEstimator<Estimator>) {
                    // Part by part: a copy would wait for them.
                    SampleId& id = ids_[gathered_];
                    id.pixel = place;
                    id.number = n++;
                    id.sign = drawn.sign;
                }
                const Vec2 p = film_place(film, place, drawn.offset);
                if (job_.aovs != nullptr) places_.push_back(p);
                if (spread_) offsets_[gathered_] = drawn.offset;
                signs_[gathered_] = drawn.sign;
                sums_[gathered_++] = eye_.column(p.x) + eye_.row(p.y);
            }
            s += static_cast<std::uint32_t>(some.size());
            if (gathered_ == sums_.size() && !trace(film, estimator)) return false;
        }
        return true;
    }
    /// Film coordinates of the centre of a pixel plus `offset` in pixels.
    [[nodiscard]] static Vec2 film_place(const Film& film, const SamplePixel& pixel,
                                         const Vec2& offset) {
        const int from_bottom = film.frame_height() - 1 - pixel.y;
        return {(pixel.x + 0.5 + offset.x) / film.frame_width(),
                (from_bottom + 0.5 + offset.y) / film.frame_height()};
    }

    /// Traces the gathered rays. False after a stop.
    template <class Estimator>
    bool trace(Film& film, Estimator& estimator) {
        if (job_.stop_requested()) return false;
        if (gathered_ == 0) return true;
        eye_.rays(std::span(sums_).first(gathered_), rays_.data());
        const std::span<Rgb> found = std::span(radiance_).first(gathered_);
        std::fill(found.begin(), found.end(), Rgb{});
        const auto rays = std::span<const Ray>(rays_).first(gathered_);
        if constexpr (SampleEstimator<Estimator>) {
            estimator.trace_samples(std::span(ids_).first(gathered_), rays, found);
        } else {
            estimator.trace(rays, found);
        }
        // A truncated batch is dropped.
        if (job_.stop_requested()) return false;
        for (std::size_t k = 0; k < gathered_; ++k) {
            const bool finite = own_.add(found[k], signs_[k]);
            counters_.non_finite += !finite;
            if (spread_ && finite) spread_->add(offsets_[k], found[k]);
            if (++taken_ == round_.count) end_pixel(film);
        }
        gathered_ = 0;
        return true;
    }

    void end_pixel(Film& film) {
        const TilePixel& pixel = pixels_[done_++];
        const int i = tile_.x0 + pixel.i, j = tile_.y0 + pixel.j;
        if (!round_.sums.empty()) {
            SampleSum& sum = round_.sums[index(film, pixel)];
            sum += own_;
            own_ = sum;
        }
        film.set(i, j, own_.value(round_.filter.mean_sign()));
        if (spread_) counters_.non_finite += !round_.shared->add(i, j, *spread_);
        if (job_.aovs != nullptr) {
            // A batch may hold samples of the next pixels.
            const std::span<const Vec2> places = std::span(places_).first(round_.count);
            aovs_.end_pixel(i, j, places);
            places_.erase(places_.begin(), places_.begin() + round_.count);
        }
        if (round_.finished != nullptr) {
            round_.finished->fetch_add(1, std::memory_order_relaxed);
        }
        own_ = {};
        taken_ = 0;
    }

    const RenderJob& job_;
    const SampleRound& round_;
    RayCounters& counters_;
    AovRecorder aovs_;
    EyeRays eye_;
    std::vector<Vec3> sums_;     ///< [ray] of a column and a row
    std::vector<double> signs_;  ///< [ray] of the filter
    std::vector<SampleId> ids_;  ///< of the gathered rays, for a SampleEstimator
    std::vector<Vec2> points_;
    std::size_t gathered_ = 0;
    std::vector<Ray> rays_;
    std::vector<Rgb> radiance_;
    PixelBox tile_;
    std::vector<TilePixel> pixels_;  ///< of the tile that are not done, in rendering order
    std::size_t done_ = 0;           ///< finished pixels
    std::uint32_t taken_ = 0;        ///< samples of the current pixel
    SampleSum own_;                  ///< of the current pixel in this round
    std::vector<Vec2> offsets_;      ///< [ray] of shared samples from the centre of their pixel
    std::optional<SharedFilm::Spread> spread_;  ///< of the current pixel
    std::vector<Vec2> places_;  ///< film coordinates of gathered samples; only with AOVs
};

/// Renders tiles by a loop over their pixels: a SampleLoop or a PixelLoop.
template <class Estimator, class Loop>
class LoopRenderer final : public TileRenderer {
  public:
    /// `more`: further arguments of the estimator.
    template <class... More>
    LoopRenderer(const RenderJob& job, std::size_t rays_at_once, const More&... more)
        : estimator_(job, rays_at_once, counters_, more...), loop_(job, rays_at_once, counters_) {}

    void render(const PixelBox& tile, Film& film, RayCounters& counters) override {
        loop_.run(tile, film, estimator_);
        counters += counters_;
        counters_ = {};
    }

  private:
    RayCounters counters_;  ///< of the tile
    Estimator estimator_;
    Loop loop_;
};

/// Renders a round of tiles.
template <class Estimator>
using RoundRenderer = LoopRenderer<Estimator, SampleLoop>;

}  // namespace alhazen
