#include "alhazen/shapes/patches/patch_pieces.h"

#include <algorithm>

namespace alhazen {

PatchPieces::PatchPieces(const std::vector<BezierPiece>& pieces) {
    for (const BezierPiece& piece : pieces) add(piece);
    shrink_to_fit();
}

void PatchPieces::add(const BezierPiece& piece) {
    const BezierNet& net = piece.net;
    const auto end = net.points.begin() + net.count();
    const bool plain =
        std::all_of(net.points.begin(), end, [](const HomogeneousPoint& p) { return p.w == 1.0; });
    heads_.push_back({points_.size(), piece.part, static_cast<std::uint8_t>(net.degree_u),
                      static_cast<std::uint8_t>(net.degree_v), plain, piece.lo, piece.hi});
    points_.insert(points_.end(), net.points.begin(), end);
}

void PatchPieces::shrink_to_fit() {
    heads_.shrink_to_fit();
    points_.shrink_to_fit();
}

BezierPiece PatchPieces::operator[](std::size_t k) const {
    const BezierView from = net(k);
    BezierPiece piece{.net = {}, .part = part(k), .lo = lo(k), .hi = hi(k)};
    piece.net.degree_u = from.degree_u;
    piece.net.degree_v = from.degree_v;
    std::copy_n(from.points, from.count(), piece.net.points.begin());
    return piece;
}

std::size_t PatchPieces::find(std::uint32_t part) const {
    if (part < size() && heads_[part].part == part) return part;
    const auto at = std::partition_point(heads_.begin(), heads_.end(),
                                         [&](const Head& head) { return head.part < part; });
    return static_cast<std::size_t>(at - heads_.begin());
}

std::size_t PatchPieces::bytes() const {
    return heads_.capacity() * sizeof(Head) + points_.capacity() * sizeof(HomogeneousPoint);
}

}  // namespace alhazen
