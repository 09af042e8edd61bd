#include "alhazen/renderers/lane_carpenter/boundary_seams.h"

#include <algorithm>

#include "alhazen/sampling/random.h"

namespace alhazen {

BoundarySeams::BoundarySeams(const ScanScene& scene) {
    for (std::uint32_t k = 0; k < scene.pieces.size(); ++k) {
        for (int side = 0; side < 4; ++side) add(scene.pieces[k].net, k, side);
    }
}

std::array<std::uint64_t, 4> BoundarySeams::of(std::uint32_t piece) const {
    const auto found = weights_.find(piece);
    return found == weights_.end() ? std::array<std::uint64_t, 4>{} : found->second;
}

void BoundarySeams::add(const BezierNet& net, std::uint32_t piece, int side) {
    std::array<HomogeneousPoint, kMaxPatchOrder> curve;
    const int count = boundary_curve(net, side, curve);
    Key forward, backward;
    for (int k = 0; k < count; ++k) {
        const HomogeneousPoint& a = curve[static_cast<std::size_t>(k)];
        const HomogeneousPoint& b = curve[static_cast<std::size_t>(count - 1 - k)];
        for (const double x : {a.x + 0.0, a.y + 0.0, a.z + 0.0, a.w}) forward.push_back(x);
        for (const double x : {b.x + 0.0, b.y + 0.0, b.z + 0.0, b.w}) backward.push_back(x);
    }
    const Side own{piece, side, backward < forward};
    const auto [waiting, is_new] = open_.try_emplace(std::min(forward, backward), own);
    if (is_new) return;
    const Side other = waiting->second;
    open_.erase(waiting);
    const std::uint64_t weight = mix64(std::uint64_t{piece} * 4 + std::uint64_t(side) + 1);
    set(own, weight);
    set(other, ~weight + 1);
}

void BoundarySeams::set(const Side& side, std::uint64_t weight) {
    weights_[side.piece][static_cast<std::size_t>(side.side)] =
        side.backward ? ~weight + 1 : weight;
}

}  // namespace alhazen
