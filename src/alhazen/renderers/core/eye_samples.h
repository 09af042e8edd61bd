#pragma once
/// Where in a pixel its eye rays go.

#include <cmath>

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

/// Film coordinates (x right, y up, both 0..1) of the only sample of pixel (i, j); j counts from
/// the top row.
inline Vec2 single_sample(SamplingConventions::PixelSample where, int i, int j, int width,
                          int height) {
    using PixelSample = SamplingConventions::PixelSample;
    const int from_bottom = height - 1 - j;
    switch (where) {
        case PixelSample::LowerLeftCorner:
            return {static_cast<double>(i) / width, static_cast<double>(from_bottom) / height};
        case PixelSample::FrameCorners:
            return {width > 1 ? static_cast<double>(i) / (width - 1) : 0.5,
                    height > 1 ? static_cast<double>(from_bottom) / (height - 1) : 0.5};
        case PixelSample::Center:
            break;
    }
    return {(i + 0.5) / width, (from_bottom + 0.5) / height};
}

/// Film coordinates of sample `s` of `count` > 1: one in each cell of a grid that is as square as
/// `count` allows, jittered. Source: Cook, "Stochastic Sampling in Computer Graphics", ACM TOG
/// 5(1), 1986, section 4 (jittering). Differs: counts that are no square leave the last row of
/// strata partly filled; its samples are spread evenly.
inline Vec2 jittered_sample(const RenderJob& job, int i, int j, int width, int height, int s) {
    const int count = job.samples_per_pixel;
    const int rows = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(count))));
    const int columns = (count + rows - 1) / rows;
    const int row = s / columns;
    const int in_row = std::min(columns, count - row * columns);
    const std::uint64_t pixel = static_cast<std::uint64_t>(j) * static_cast<std::uint64_t>(width) +
                                static_cast<std::uint64_t>(i);
    const double dx = random_at(job.seed, pixel, static_cast<std::uint64_t>(s), 0);
    const double dy = random_at(job.seed, pixel, static_cast<std::uint64_t>(s), 1);
    const double x = (s % columns + dx) / in_row;
    const double y = (row + dy) / rows;
    return {(i + x) / width, (height - 1 - j + y) / height};
}

/// Film coordinates of sample `s` of pixel (i, j), as the job asks.
inline Vec2 eye_sample(const RenderJob& job, int i, int j, int width, int height, int s) {
    return job.samples_per_pixel == 1
               ? single_sample(job.scene.conventions.sampling.pixel_sample, i, j, width, height)
               : jittered_sample(job, i, j, width, height, s);
}

}  // namespace alhazen
