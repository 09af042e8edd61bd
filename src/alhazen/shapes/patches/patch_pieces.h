#pragma once
/// Rational Bezier patches of a surface: single pieces, and compact storage of many.

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

/// Compact storage of pieces: 48 bytes per piece and 32 per point, where a BezierPiece has a
/// capacity for the highest degrees.
class PatchPieces {
  public:
    PatchPieces() = default;
    explicit PatchPieces(const std::vector<BezierPiece>& pieces);

    void add(const BezierPiece& piece);
    /// Frees memory that `add` reserved but did not use.
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
    /// The index of the piece with this part. Preconditions: parts ascend, and there is one.
    [[nodiscard]] std::size_t find(std::uint32_t part) const;
    [[nodiscard]] std::size_t bytes() const;

  private:
    struct Head {
        std::uint64_t first;  ///< index of its first point
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
