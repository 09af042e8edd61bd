#pragma once
/// Boxes for tests of builders.

#include <vector>

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/sampling/random.h"

namespace alhazen::testing {

class Boxes final : public BoundsSource {
  public:
    explicit Boxes(std::vector<Box3> boxes) : boxes_(std::move(boxes)) {}
    [[nodiscard]] std::size_t size() const override { return boxes_.size(); }
    [[nodiscard]] Box3 box(std::size_t i) const override { return boxes_[i]; }

  private:
    std::vector<Box3> boxes_;
};

/// Many copies of one slanted plate in the unit cube: where x + y / 10 is 0.7.
class SlantedHeap final : public BoundsSource {
  public:
    explicit SlantedHeap(std::size_t count) : count_(count) {}
    [[nodiscard]] std::size_t size() const override { return count_; }
    [[nodiscard]] Box3 box(std::size_t) const override { return {{0, 0, 0}, {1, 1, 1}}; }
    [[nodiscard]] bool overlaps(std::size_t, const Box3& cell) const override {
        ++tests_;
        return cell.lo.x + 0.1 * cell.lo.y <= 0.7 && cell.hi.x + 0.1 * cell.hi.y >= 0.7;
    }

    [[nodiscard]] std::size_t tests() const { return tests_; }

  private:
    std::size_t count_;
    mutable std::size_t tests_ = 0;
};

inline Boxes random_boxes(std::size_t count, double size, std::uint64_t seed) {
    RandomStream random(seed);
    std::vector<Box3> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        Box3 box;
        for (int k = 0; k < 3; ++k) {
            box.lo[k] = random.uniform(-1, 1);
            box.hi[k] = box.lo[k] + size * random.uniform();
        }
        boxes.push_back(box);
    }
    return Boxes(boxes);
}

/// Boxes with integer corners: many coincide, touch or are flat.
inline Boxes lattice_boxes(std::size_t count, std::uint64_t reach, std::uint64_t seed) {
    RandomStream random(seed);
    std::vector<Box3> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        Box3 box;
        for (int k = 0; k < 3; ++k) {
            box.lo[k] = static_cast<double>(random.below(reach));
            box.hi[k] = box.lo[k] + static_cast<double>(random.below(3));
        }
        boxes.push_back(box);
    }
    return Boxes(boxes);
}

}  // namespace alhazen::testing
