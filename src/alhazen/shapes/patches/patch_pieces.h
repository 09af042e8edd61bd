#pragma once
/// The rational Bezier patches of a surface: one by one, and many together in little memory.

#include <cstdint>
#include <vector>

#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

/// One rational Bezier patch of a surface.
struct BezierPiece {
    BezierNet net;
    std::uint32_t part = 0;
    Vec2 lo{0, 0}, hi{1, 1};  ///< the surface's parameters at the corners of the piece
};

/// Pieces with their control points one after the other: 48 bytes a piece and 32 a point, where a
/// BezierPiece has room for the highest degrees.
class PatchPieces {
  public:
    PatchPieces() = default;
    explicit PatchPieces(const std::vector<BezierPiece>& pieces);

    void add(const BezierPiece& piece);
    /// Gives back what `add` reserved and did not use.
    void shrink_to_fit();

    [[nodiscard]] std::size_t size() const { return heads_.size(); }
    [[nodiscard]] BezierPiece operator[](std::size_t k) const;
    [[nodiscard]] BezierView net(std::size_t k) const {
        const Head& head = heads_[k];
        return {head.degree_u, head.degree_v, &points_[head.first], head.plain};
    }
    [[nodiscard]] std::uint32_t part(std::size_t k) const { return heads_[k].part; }
    [[nodiscard]] const Vec2& lo(std::size_t k) const { return heads_[k].lo; }
    [[nodiscard]] const Vec2& hi(std::size_t k) const { return heads_[k].hi; }
    /// The piece of that part. Preconditions: parts ascend, and there is one.
    [[nodiscard]] std::size_t find(std::uint32_t part) const;
    [[nodiscard]] std::size_t bytes() const;

  private:
    struct Head {
        std::uint64_t first;  ///< of its points
        std::uint32_t part;
        std::uint8_t degree_u, degree_v;
        bool plain;
        Vec2 lo, hi;
    };
    static_assert(sizeof(Head) == 48);

    std::vector<Head> heads_;
    std::vector<HomogeneousPoint> points_;
};

}  // namespace alhazen
