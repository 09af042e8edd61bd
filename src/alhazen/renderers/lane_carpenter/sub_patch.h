#pragma once
/// Sub-patches: parts of a patch in homogeneous screen space with the state of their edges, and a
/// memory pool for them.
///
/// Source: Lane, Carpenter, Whitted and Blinn, "Scan Line Methods for Displaying Parametrically
/// Defined Surfaces", CACM 23(1), 1980; Clark, "A Fast Scan-Line Algorithm for Rendering Parametric
/// Surfaces", SIGGRAPH 1979 (edges that stay straight).
/// Conventions: sides are in the order of boundary_curve: v = 0, u = 1, v = 1, u = 0, each towards
/// ascending parameters. Rows are those of SampleGrid.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "alhazen/renderers/lane_carpenter/screen_view.h"

namespace alhazen {

/// A line through two points of the grid, towards ascending parameters.
struct EdgeChord {
    FixedPoint from, to;
};

/// The next step for a sub-patch.
enum class PatchStep : std::uint8_t {
    None,    ///< it is invisible
    Draw,    ///< it is flat
    SplitU,  ///< it is flat along v
    SplitV,
    SplitBoth,
};

struct SubPatch {
    std::uint32_t piece = 0;
    std::uint32_t next = 0;  ///< in the bucket
    std::int32_t first_row = 0;
    PatchStep step = PatchStep::None;
    bool projects = true;             ///< all control points are in front of the eye
    std::uint8_t straight_sides = 0;  ///< bit of each side that is known to be straight
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
    std::array<EdgeChord, 4> chords{};     ///< of straight sides: lines unchanged by splitting
    std::array<std::uint64_t, 4> seams{};  ///< weights for counting cracks
    HomogeneousPoint* points = nullptr;    ///< u-major, in screen space

    [[nodiscard]] bool is_straight(std::size_t side) const {
        return (straight_sides >> side & 1u) != 0;
    }
};

/// A pool of sub-patches with at most `points` control points each.
class SubPatchPool {
  public:
    explicit SubPatchPool(std::size_t points) : points_(points) {}

    [[nodiscard]] std::uint32_t take() {
        if (free_.empty()) grow();
        const std::uint32_t index = free_.back();
        free_.pop_back();
        ++live_;
        most_ = live_ > most_ ? live_ : most_;
        return index;
    }
    void give_back(std::uint32_t index) {
        free_.push_back(index);
        --live_;
    }
    [[nodiscard]] SubPatch& at(std::uint32_t index) {
        return blocks_[index / kBlock]->patches[index % kBlock];
    }
    [[nodiscard]] std::size_t live() const { return live_; }
    /// Largest number in use at one time.
    [[nodiscard]] std::size_t most() const { return most_; }
    [[nodiscard]] std::size_t bytes_each() const {
        return sizeof(SubPatch) + points_ * sizeof(HomogeneousPoint);
    }

  private:
    static constexpr std::uint32_t kBlock = 256;
    struct Block {
        std::array<SubPatch, kBlock> patches;
        std::vector<HomogeneousPoint> points;
    };

    void grow() {
        auto block = std::make_unique<Block>();
        block->points.resize(kBlock * points_);
        const auto first = static_cast<std::uint32_t>(blocks_.size()) * kBlock;
        for (std::uint32_t k = kBlock; k-- > 0;) {
            block->patches[k].points = block->points.data() + k * points_;
            free_.push_back(first + k);
        }
        blocks_.push_back(std::move(block));
    }

    std::size_t points_;
    std::vector<std::unique_ptr<Block>> blocks_;
    std::vector<std::uint32_t> free_;
    std::size_t live_ = 0, most_ = 0;
};

}  // namespace alhazen
