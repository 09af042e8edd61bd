#include "alhazen/renderers/photon_mapping/irradiance_cache.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

std::array<std::int64_t, 3> cache_cell(const Vec3& point, int level) {
    constexpr double kMost = 0x1p60;
    const auto of = [&](double x) {
        return static_cast<std::int64_t>(
            std::clamp(std::floor(std::ldexp(x, -level)), -kMost, kMost));
    };
    return {of(point.x), of(point.y), of(point.z)};
}

}  // namespace

double IrradianceCache::error_at(const IrradianceRecord& record, const Vec3& point,
                                 const Vec3& normal) {
    const Vec3 apart = point - record.point;
    // A record behind the point may not see what the point sees.
    if (dot(apart, record.normal + normal) < -0.1 * record.distance) return kInfinity;
    const double turned = 1.0 - dot(normal, record.normal);
    return length(apart) / record.distance + std::sqrt(std::max(0.0, turned));
}

void IrradianceCache::add(const IrradianceRecord& record) {
    const double reach = error_ * record.distance;
    if (!(reach > 1e-150 && reach < 1e150)) return;
    const auto number = static_cast<std::uint32_t>(records_.size());
    records_.push_back(record);
    // Cells are at least twice as wide as the reach.
    const int level = std::ilogb(2.0 * reach) + 1;
    Level& cells = levels_[level];
    const Vec3 far{reach, reach, reach};
    const Cell low = cache_cell(record.point - far, level);
    const Cell high = cache_cell(record.point + far, level);
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        for (std::int64_t y = low[1]; y <= high[1]; ++y) {
            for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                cells.cells[{x, y, z}].push_back(number);
            }
        }
    }
}

std::optional<Spectrum> IrradianceCache::irradiance(const Vec3& point, const Vec3& normal) const {
    Spectrum sum;
    double weights = 0.0;
    for (const auto& [level, cells] : levels_) {
        const auto cell = cells.cells.find(cache_cell(point, level));
        if (cell == cells.cells.end()) continue;
        for (const std::uint32_t number : cell->second) {
            const double error = error_at(records_[number], point, normal);
            if (!(error < error_)) continue;
            // Ward's weight 1 / error, minus its value at the end of the reach, for continuity.
            const double weight = 1.0 / std::max(error, 1e-6) - 1.0 / error_;
            sum += weight * records_[number].irradiance;
            weights += weight;
        }
    }
    if (!(weights > 0.0)) return std::nullopt;
    return (1.0 / weights) * sum;
}

}  // namespace alhazen
