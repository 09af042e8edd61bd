#include "alhazen/renderers/photons/photon_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "alhazen/sampling/random.h"

namespace alhazen {

PhotonGrid::PhotonGrid(std::vector<Photon> photons, double radius) : radius_(radius) {
    const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(1, photons.size()));
    mask_ = buckets - 1;
    first_.assign(buckets + 1, 0);
    for (const Photon& p : photons) ++first_[bucket_of(cell_of(p.point())) + 1];
    for (std::size_t b = 0; b < buckets; ++b) first_[b + 1] += first_[b];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    photons_.resize(photons.size());
    for (const Photon& p : photons) photons_[next[bucket_of(cell_of(p.point()))]++] = p;
}

PhotonGrid::Cell PhotonGrid::cell_of(const Vec3& point) const {
    // Beyond this a cell is smaller than the rounding of the coordinate.
    constexpr double kMost = 0x1p60;
    const double side = 2.0 * radius_;
    const auto of = [&](double x) {
        return static_cast<std::int64_t>(std::clamp(std::floor(x / side), -kMost, kMost));
    };
    return {of(point.x), of(point.y), of(point.z)};
}

std::size_t PhotonGrid::bucket_of(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t c : cell) hash = mix64(hash ^ static_cast<std::uint64_t>(c));
    return static_cast<std::size_t>(hash) & mask_;
}

}  // namespace alhazen
