#include "alhazen/geometry/cones/coverage_tables.h"

#include "alhazen/geometry/cones/disc_area.h"
#include "alhazen/math/constants.h"

namespace alhazen {

CoverageTables::CoverageTables() {
    spheres_.reserve((kRadii + 1) * (kDistances + 1));
    for (std::size_t j = 0; j <= kRadii; ++j) {
        const double y = static_cast<double>(j) / kRadii;
        for (std::size_t i = 0; i <= kDistances; ++i) {
            const double x = static_cast<double>(i) / kDistances;
            if (j == 0 || j == kRadii) {
                // The part of the smaller disc beyond a line.
                spheres_.push_back(static_cast<float>(segment_area(1.0, 2.0 * x - 1.0) / kPi));
                continue;
            }
            const double R = y / (1.0 - y), least = std::abs(R - 1.0);
            const double d = least + x * (R + 1.0 - least);
            const double smaller = std::min(R, 1.0);
            spheres_.push_back(
                static_cast<float>(lens_area(1.0, R, d) / (kPi * smaller * smaller)));
        }
    }
    for (std::size_t i = 0; i <= kPlanes; ++i) {
        planes_[i] = segment_area(1.0, 2.0 * static_cast<double>(i) / kPlanes - 1.0) / kPi;
    }
}

const CoverageTables& CoverageTables::shared() {
    static const CoverageTables tables;
    return tables;
}

}  // namespace alhazen
