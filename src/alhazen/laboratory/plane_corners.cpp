#include "alhazen/laboratory/plane_corners.h"

#include <algorithm>
#include <cmath>

namespace alhazen {
namespace {

/// Relative tolerance for rounding; far below what a drawing shows.
constexpr double kTolerance = 1e-9;

}  // namespace

std::vector<Vec3> plane_corners(std::span<const HalfSpaceOfPoints> sides) {
    std::vector<Vec3> corners;
    double reach = 0;
    for (const HalfSpaceOfPoints& side : sides) reach = std::max(reach, std::abs(side.offset));
    for (std::size_t i = 0; i < sides.size(); ++i) {
        for (std::size_t j = i + 1; j < sides.size(); ++j) {
            for (std::size_t k = j + 1; k < sides.size(); ++k) {
                const Vec3 &a = sides[i].normal, &b = sides[j].normal, &c = sides[k].normal;
                const double volume = dot(a, cross(b, c));
                if (std::abs(volume) < 1e-6) continue;
                const Vec3 p = (sides[i].offset * cross(b, c) + sides[j].offset * cross(c, a) +
                                sides[k].offset * cross(a, b)) /
                               volume;
                const bool inside =
                    std::all_of(sides.begin(), sides.end(), [&](const HalfSpaceOfPoints& side) {
                        return dot(side.normal, p) <= side.offset + kTolerance * (1 + reach);
                    });
                if (inside) corners.push_back(p);
            }
        }
    }
    return corners;
}

}  // namespace alhazen
