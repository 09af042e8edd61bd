#pragma once
/// The film: radiance per pixel, in double, written by several threads during rendering.
///
/// Conventions: pixel (0, 0) is the top left of the full frame; the film holds the crop [x0, x1) x
/// [y0, y1) of it. Threads: different pixels may be set, by `set` or `from`, at the same time.

#include <cstdint>
#include <vector>

#include "alhazen/base/zero_pages.h"
#include "alhazen/imaging/image/image.h"

namespace alhazen {

/// A half-open rectangle of pixels.
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    [[nodiscard]] int width() const { return x1 - x0; }
    [[nodiscard]] int height() const { return y1 - y0; }
    [[nodiscard]] std::uint64_t area() const {
        return std::uint64_t(width()) * std::uint64_t(height());
    }
    friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

class Film {
  public:
    /// Throws Error (Usage) if the crop is empty or not inside the frame.
    Film(int frame_width, int frame_height, const PixelBox& crop);

    [[nodiscard]] int frame_width() const { return frame_width_; }
    [[nodiscard]] int frame_height() const { return frame_height_; }
    [[nodiscard]] const PixelBox& crop() const { return crop_; }

    void set(int x, int y, const Rgb& radiance) { samples_[index(x, y)] = radiance; }
    /// The pixels of row y from x on; the next row starts one crop width later.
    [[nodiscard]] Rgb* from(int x, int y) { return &samples_[index(x, y)]; }
    [[nodiscard]] const Rgb& at(int x, int y) const { return samples_[index(x, y)]; }
    /// [crop height][crop width][3], for `encode` (encoding.h).
    [[nodiscard]] const double* data() const { return &samples_.front().r; }
    /// The crop as a float image.
    [[nodiscard]] Image to_image() const;

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return std::size_t(y - crop_.y0) * std::size_t(crop_.width()) + std::size_t(x - crop_.x0);
    }

    int frame_width_, frame_height_;
    PixelBox crop_;
    // With 4 KiB pages a large film would cost thousands of page faults.
    std::vector<Rgb, ZeroPageAllocator<Rgb>> samples_;
};

/// The tiles of the crop, of at most `tile_size` squared pixels, row by row.
[[nodiscard]] std::vector<PixelBox> tiles_of(const PixelBox& crop, int tile_size);

}  // namespace alhazen
