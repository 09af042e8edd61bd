#include "alhazen/illumination/light_importance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace alhazen {

namespace {

/// The lower and the upper half of a word, as signed numbers.
float lower_number(std::uint32_t word) {
    return static_cast<float>(static_cast<std::int16_t>(word & 0xFFFFu));
}
float upper_number(std::uint32_t word) {
    return static_cast<float>(static_cast<std::int16_t>(word >> 16));
}

/// True if a point at the offset -(x, y, z) is outside of the cone of emission.
bool is_outside(const LightTree::Cones& cones, std::size_t i, float x, float y, float z) {
    const float distance = std::sqrt(x * x + y * y + z * z);
    const float along = -(cones.axis[0][i] * x + cones.axis[1][i] * y + cones.axis[2][i] * z);
    const float cosine = cones.cosine[i];
    return along < (cosine - 1e-4f) * distance - (1.0f + std::abs(cosine)) * cones.radius[i];
}

}  // namespace

PointOfTree::PointOfTree(const LightTree& tree, const LitPoint& at)
    : both_sides(at.both_sides), in_volume(at.in_volume) {
    double place[3], most = 0.0;
    for (int k = 0; k < 3; ++k) {
        place[k] = (at.point[k] - tree.origin()[k]) * tree.scale();
        most = std::max(most, std::abs(place[k]));
    }
    const double nearer = most > kFarFromLights ? kFarFromLights / most : 1.0;
    for (int k = 0; k < 3; ++k) {
        point[k] = static_cast<float>(place[k] * nearer);
        normal[k] = static_cast<float>(at.normal[k]);
    }
}

std::array<float, LightTree::kWidth> importances(const LightTree::Node& node,
                                                 const LightTree::Cones* cones,
                                                 const PointOfTree& at) {
    constexpr float kUnit = 1.0f / LightTree::kAxisUnits;
    std::array<float, LightTree::kWidth> result;
    for (std::size_t i = 0; i < LightTree::kWidth; ++i) {
        const float x = node.center[0][i] - at.point[0], y = node.center[1][i] - at.point[1],
                    z = node.center[2][i] - at.point[2];
        const float squared = x * x + y * y + z * z, variance = node.variance[i];
        const float intensity =
            std::bit_cast<float>(node.intensity_turn[i] & LightTree::kIntensityMask);
        const float turn =
            std::bit_cast<float>(node.intensity_turn[i] << (32 - LightTree::kTurnBits));
        const float axis_x = lower_number(node.axis_xy[i]), axis_y = upper_number(node.axis_xy[i]);
        const float axis_z = lower_number(node.axis_z_radius2[i]);
        const float radius2 = std::bit_cast<float>(node.axis_z_radius2[i] & 0xFFFF0000u);

        const float along = (axis_x * x + axis_y * y + axis_z * z) * -kUnit;
        const float sent_root = std::sqrt(along * along + turn * squared + variance);
        const float sent = sent_root + (intensity < 0.0f ? sent_root : along);

        const float height = at.normal[0] * x + at.normal[1] * y + at.normal[2] * z;
        const float grazing = kGrazing * squared, height2 = height * height;
        const float received_root = std::sqrt(height2 + (variance + grazing));
        const float spread = squared + variance;
        float received = received_root + (at.both_sides ? received_root : height);
        if (at.in_volume) received = 2.0f * std::sqrt(spread);
        const bool below = height < 0.0f && height2 >= radius2 + grazing;
        const float importance = std::abs(intensity) * sent * received / (spread * spread);
        const bool dark = (below && !at.both_sides && !at.in_volume) ||
                          (cones != nullptr && is_outside(*cones, i, x, y, z));
        result[i] = dark ? 0.0f : importance;
    }
    return result;
}

}  // namespace alhazen
