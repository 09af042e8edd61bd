#pragma once
/// An image pyramid: copies of decreasing size, each half as large, down to one texel.
///
/// Source: Williams, "Pyramidal Parametrics", SIGGRAPH 1983.
/// Differs: sides need not be powers of two: a texel of a copy is the mean over exactly the area
/// that it covers, with fractional weights at the border.
/// Conventions: values are linear and are averaged after sRGB decoding; alpha is averaged
/// separately, not premultiplied. Copies of integer pictures are stored as 16-bit linear codes,
/// others as floats. Level 0 is the picture itself, which is not copied.

#include <cstdint>
#include <memory>

#include "alhazen/imaging/codecs/stored_image.h"

namespace alhazen {

class MipPyramid {
  public:
    /// Throws std::bad_alloc only. Memory: the copies, of 16-bit codes, take two thirds of the size
    /// of an 8-bit picture, and a third of a 16-bit one.
    MipPyramid(std::shared_ptr<const StoredImage> image, bool decode_srgb);

    [[nodiscard]] int levels() const { return static_cast<int>(smaller_.size()) + 1; }
    [[nodiscard]] int width(int level) const { return at(level).width; }
    [[nodiscard]] int height(int level) const { return at(level).height; }
    /// Linear colour. Precondition: 0 <= level < levels(), x and y inside.
    [[nodiscard]] Rgba texel(int level, int x, int y) const;
    /// Size of the copies (levels above 0).
    [[nodiscard]] std::size_t memory_bytes() const;
    /// Predicts `memory_bytes` without building.
    [[nodiscard]] static std::uint64_t memory_bytes_for(const StoredImage& image);

  private:
    [[nodiscard]] const StoredImage& at(int level) const {
        return level == 0 ? *image_ : smaller_[static_cast<std::size_t>(level - 1)];
    }

    std::shared_ptr<const StoredImage> image_;
    bool decode_srgb_;
    std::vector<StoredImage> smaller_;
};

}  // namespace alhazen
