#pragma once
/// The loop over the pixels and samples of tiles that renderers share.
///
/// Source: none. Differs: nothing. Conventions: all memory is kept from tile to tile. Threads:
/// belongs to one.

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/eye_samples.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

/// Gathers eye rays, block by block of pixels, and gives their light back to the pixels.
class PixelLoop {
  public:
    /// `at_once`: so many samples are traced together at most.
    PixelLoop(const RenderJob& job, std::size_t at_once, RayCounters& counters)
        : job_(job),
          counters_(counters),
          aovs_(job, counters),
          eye_(job.camera),
          sums_(at_once),
          rays_(at_once),
          radiance_(at_once) {}

    /// Calls `radiance(std::span<const Ray> eye_rays, std::span<Rgb> radiance)` for some samples
    /// after the other, until it has all, and writes the mean of a pixel's finite ones to the film.
    /// Returns early when the job is to stop; no pixel is left half done.
    template <class Radiance>
    void run(const PixelBox& tile, Film& film, Radiance&& radiance) {
        begin_tile(tile, film);
        if (is_plain()) return run_plain(film, radiance);
        // What a pixel costs is known where its rays are alone.
        const bool alone = job_.aovs != nullptr && job_.aovs->wanted().has_costs();
        for (const Pixel& pixel : pixels_) {
            if (job_.aovs != nullptr) aovs_.begin_pixel();
            for (int s = 0; s < job_.samples_per_pixel; ++s) {
                sums_[gathered_++] = sum_of(pixel, s);
                if (gathered_ == sums_.size() && !trace(film, radiance)) return;
            }
            if (alone && !trace(film, radiance)) return;
        }
        trace(film, radiance);
    }

  private:
    /// Every pixel has one sample, and nobody records how it came about.
    [[nodiscard]] bool is_plain() const {
        return job_.samples_per_pixel == 1 && job_.aovs == nullptr;
    }
    /// As `run`.
    template <class Radiance>
    void run_plain(Film& film, Radiance& radiance) {
        std::span<const Pixel> rest = pixels_;
        while (!rest.empty()) {
            const std::span<const Pixel> next = rest.first(std::min(rest.size(), sums_.size()));
            for (const Pixel& pixel : next) sums_[gathered_++] = sum_of_single(pixel);
            if (!trace(film, radiance)) return;
            rest = rest.subspan(next.size());
        }
    }

    /// Counted from the corner of the tile.
    struct Pixel {
        int i, j;
    };

    void begin_tile(const PixelBox& tile, const Film& film) {
        width_ = film.frame_width();
        height_ = film.frame_height();
        gathered_ = done_ = 0;
        samples_ = finite_ = 0;
        sum_ = {};
        if (pixels_.empty() || tile.width() != tile_.width() || tile.height() != tile_.height()) {
            list_pixels(tile.width(), tile.height());
        }
        tile_ = tile;
        if (job_.samples_per_pixel != 1) return;
        columns_.clear();
        rows_.clear();
        const auto sample = [&](int i, int j) {
            return single_sample(job_.scene.conventions.sampling.pixel_sample, i, j, width_,
                                 height_);
        };
        for (int i = tile.x0; i < tile.x1; ++i) columns_.push_back(eye_.column(sample(i, 0).x));
        for (int j = tile.y0; j < tile.y1; ++j) rows_.push_back(eye_.row(sample(0, j).y));
    }

    /// Blocks of pixels, and in these cells of eight, whose rays are tested together: rays that
    /// follow each other stay near each other.
    void list_pixels(int width, int height) {
        constexpr int kBlock = 8, kCellWidth = 4, kCellHeight = 2;
        pixels_.clear();
        const auto for_parts = [](int begin, int end, int step, auto&& f) {
            for (int at = begin; at < end; at += step) f(at, std::min(at + step, end));
        };
        const auto add_cells = [&](int x0, int x1, int y0, int y1) {
            for_parts(y0, y1, kCellHeight, [&](int cell_y0, int cell_y1) {
                for_parts(x0, x1, kCellWidth, [&](int cell_x0, int cell_x1) {
                    for (int j = cell_y0; j < cell_y1; ++j) {
                        for (int i = cell_x0; i < cell_x1; ++i) pixels_.push_back({i, j});
                    }
                });
            });
        };
        for_parts(0, height, kBlock, [&](int y0, int y1) {
            for_parts(0, width, kBlock, [&](int x0, int x1) { add_cells(x0, x1, y0, y1); });
        });
    }

    /// What makes the eye ray of a pixel's only sample.
    [[nodiscard]] Vec3 sum_of_single(const Pixel& pixel) const {
        return columns_[static_cast<std::size_t>(pixel.i)] +
               rows_[static_cast<std::size_t>(pixel.j)];
    }
    [[nodiscard]] Vec3 sum_of(const Pixel& pixel, int s) const {
        if (job_.samples_per_pixel == 1) return sum_of_single(pixel);
        const Vec2 p =
            jittered_sample(job_, tile_.x0 + pixel.i, tile_.y0 + pixel.j, width_, height_, s);
        return eye_.column(p.x) + eye_.row(p.y);
    }

    /// False when the job is to stop.
    template <class Radiance>
    bool trace(Film& film, Radiance& radiance) {
        if (job_.stop_requested()) return false;
        eye_.rays(std::span(sums_).first(gathered_), rays_.data());
        const std::span<Rgb> found = std::span(radiance_).first(gathered_);
        std::fill(found.begin(), found.end(), Rgb{});
        radiance(std::span<const Ray>(rays_).first(gathered_), found);
        // What was cut short is given up.
        if (job_.stop_requested()) return false;
        if (is_plain()) {
            take_pixels(film, found);
        } else {
            for (const Rgb& c : found) take(film, c);
        }
        gathered_ = 0;
        return true;
    }

    /// As `take`, where each is a pixel and nobody records them.
    void take_pixels(Film& film, std::span<const Rgb> found) {
        const Pixel* pixel = pixels_.data() + done_;
        Rgb* const corner = film.from(tile_.x0, tile_.y0);
        const std::ptrdiff_t stride = film.crop().width();
        std::uint64_t non_finite = 0;
        for (const Rgb& c : found) {
            const bool finite = c.is_finite();
            non_finite += !finite;
            corner[pixel->j * stride + pixel->i] = finite ? Rgb{} + c : Rgb{};
            ++pixel;
        }
        counters_.non_finite += non_finite;
        done_ += found.size();
    }

    void take(Film& film, const Rgb& c) {
        if (c.is_finite()) {
            sum_ += c;
            ++finite_;
        } else {
            ++counters_.non_finite;
        }
        if (++samples_ == job_.samples_per_pixel) end_pixel(film);
    }

    void end_pixel(Film& film) {
        const Pixel& pixel = pixels_[done_++];
        const int i = tile_.x0 + pixel.i, j = tile_.y0 + pixel.j;
        film.set(i, j, finite_ == 1 ? sum_ : finite_ > 1 ? (1.0 / finite_) * sum_ : Rgb{});
        if (job_.aovs != nullptr) aovs_.end_pixel(i, j, width_, height_);
        sum_ = {};
        finite_ = samples_ = 0;
    }

    const RenderJob& job_;
    RayCounters& counters_;
    AovRecorder aovs_;
    EyeRays eye_;
    int width_ = 0, height_ = 0;        ///< of the frame
    std::vector<Vec3> columns_, rows_;  ///< of the tile, where a pixel has one sample
    std::vector<Vec3> sums_;            ///< of a column and a row
    std::size_t gathered_ = 0;          ///< of them
    std::vector<Ray> rays_;
    std::vector<Rgb> radiance_;
    PixelBox tile_;
    std::vector<Pixel> pixels_;  ///< of the tile, in the order in which they are done
    std::size_t done_ = 0;       ///< pixels that have their light
    int samples_ = 0, finite_ = 0;
    Rgb sum_;
};

/// Renders tiles with `Integrator(job, rays_at_once, counters)`, whose `trace(eye_rays, radiance)`
/// does the work.
template <class Integrator>
class PixelRenderer final : public TileRenderer {
  public:
    PixelRenderer(const RenderJob& job, std::size_t rays_at_once)
        : integrator_(job, rays_at_once, counters_), loop_(job, rays_at_once, counters_) {}

    void render(const PixelBox& tile, Film& film, RayCounters& counters) override {
        loop_.run(tile, film, [&](std::span<const Ray> rays, std::span<Rgb> radiance) {
            integrator_.trace(rays, radiance);
        });
        counters += counters_;
        counters_ = {};
    }

  private:
    RayCounters counters_;  ///< of the tile
    Integrator integrator_;
    PixelLoop loop_;
};

}  // namespace alhazen
