#include "alhazen/shapes/patches/patch_checks.h"

#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

void check_patch_degrees(FieldChecks& checks, std::uint32_t degree_u, std::uint32_t degree_v) {
    const auto check = [&](const char* name, std::uint32_t degree) {
        if (degree < 1 || degree > static_cast<std::uint32_t>(kMaxPatchDegree)) {
            checks.fail(std::string(name) + " must be from 1 to " +
                        std::to_string(kMaxPatchDegree) + ", not " + std::to_string(degree));
        }
    };
    check("degree_u", degree_u);
    check("degree_v", degree_v);
}

void check_control_points(FieldChecks& checks, std::span<const Vec3> points,
                          std::span<const double> weights) {
    for (std::size_t k = 0; k < points.size(); ++k) {
        const std::string name = "point " + std::to_string(k);
        checks.point(name.c_str(), points[k]);
    }
    if (!weights.empty() && weights.size() != points.size()) {
        checks.fail("expected one weight for each of the " + std::to_string(points.size()) +
                    " points, found " + std::to_string(weights.size()));
    }
    for (std::size_t k = 0; k < weights.size(); ++k) {
        if (!(weights[k] >= 1e-6 && weights[k] <= 1e6)) {
            checks.fail("weight " + std::to_string(k) + " must be from 1e-6 to 1e6, not " +
                        std::to_string(weights[k]));
        }
    }
}

}  // namespace alhazen
