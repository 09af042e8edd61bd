#pragma once
/// Vectors in JSON: lists of three numbers, null for those that are not finite.

#include <cmath>
#include <nlohmann/json.hpp>

#include "alhazen/math/vec.h"

namespace alhazen {

[[nodiscard]] inline nlohmann::ordered_json number_json(double x) {
    return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}
[[nodiscard]] inline nlohmann::ordered_json vector_json(const Vec3& v) {
    return nlohmann::ordered_json::array({number_json(v.x), number_json(v.y), number_json(v.z)});
}

}  // namespace alhazen
