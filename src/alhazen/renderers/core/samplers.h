#pragma once
/// Samplers: the positions of eye rays in a pixel.
///
/// A sampler is a small value created for a job and a frame size; PixelSampler states the
/// interface.
/// Conventions: film coordinates, x right and y up, both 0..1 over the frame; pixel (i, j) of the
/// frame with j counted from the top row. A sample depends only on the job, the pixel and its
/// number.

#include <algorithm>
#include <cmath>
#include <concepts>

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

/// `count()`: samples of each pixel. `at(i, j, s)`: film coordinates of sample s in 0 .. count()
/// - 1. `kSeparable`: count() is 1, x depends on i alone and y on j alone.
template <class S>
concept PixelSampler = requires(const S& sampler, const RenderJob& job, int n) {
    S(job, n, n);  // job, width and height of the frame
    { sampler.count() } -> std::same_as<int>;
    { sampler.at(n, n, n) } -> std::same_as<Vec2>;
    { S::kSeparable } -> std::convertible_to<bool>;
};

/// One sample per pixel, at the point given by the scene's conventions.
class PointSampler {
  public:
    using PixelSample = SamplingConventions::PixelSample;
    static constexpr bool kSeparable = true;

    PointSampler(const RenderJob& job, int width, int height)
        : PointSampler(job.scene.conventions.sampling.pixel_sample, width, height) {}
    PointSampler(PixelSample where, int width, int height)
        : where_(where), width_(width), height_(height) {}

    [[nodiscard]] static int count() { return 1; }
    [[nodiscard]] Vec2 at(int i, int j, int /*s*/ = 0) const {
        const int from_bottom = height_ - 1 - j;
        switch (where_) {
            case PixelSample::LowerLeftCorner:
                return {static_cast<double>(i) / width_,
                        static_cast<double>(from_bottom) / height_};
            case PixelSample::FrameCorners:
                return {width_ > 1 ? static_cast<double>(i) / (width_ - 1) : 0.5,
                        height_ > 1 ? static_cast<double>(from_bottom) / (height_ - 1) : 0.5};
            case PixelSample::Center:
                break;
        }
        return {(i + 0.5) / width_, (from_bottom + 0.5) / height_};
    }

  private:
    PixelSample where_;
    int width_, height_;
};

/// Stratified jitter: one sample in each cell of a grid that is as square as the count allows.
///
/// Source: Cook, "Stochastic Sampling in Computer Graphics", ACM TOG 5(1), 1986, section 4
/// (jittering).
/// Differs: where the count is not divisible by the number of rows, the last row has fewer, wider
/// cells.
class JitteredSampler {
  public:
    static constexpr bool kSeparable = false;

    JitteredSampler(const RenderJob& job, int width, int height)
        : seed_(job.seed),
          width_(width),
          height_(height),
          count_(job.samples_per_pixel),
          rows_(std::max(1, static_cast<int>(std::sqrt(static_cast<double>(count_))))),
          columns_((count_ + rows_ - 1) / rows_) {}

    [[nodiscard]] int count() const { return count_; }
    [[nodiscard]] Vec2 at(int i, int j, int s) const {
        const int row = s / columns_;
        const int in_row = std::min(columns_, count_ - row * columns_);
        const std::uint64_t pixel =
            static_cast<std::uint64_t>(j) * static_cast<std::uint64_t>(width_) +
            static_cast<std::uint64_t>(i);
        const double dx = random_at(seed_, pixel, static_cast<std::uint64_t>(s), 0);
        const double dy = random_at(seed_, pixel, static_cast<std::uint64_t>(s), 1);
        const double x = (s % columns_ + dx) / in_row;
        const double y = (row + dy) / rows_;
        return {(i + x) / width_, (height_ - 1 - j + y) / height_};
    }

  private:
    std::uint64_t seed_;
    int width_, height_;
    int count_;
    int rows_, columns_;  ///< of cells
};

static_assert(PixelSampler<PointSampler> && PixelSampler<JitteredSampler>);

}  // namespace alhazen
