#include "alhazen/formats/native/read/native_view_fields.h"

#include <string>

#include "alhazen/math/constants.h"

namespace alhazen {

std::string_view require_one_of(BlockReader& reader, std::string_view a, std::string_view b) {
    if (reader.has(a) == reader.has(b)) {
        reader.error(reader.block(), "expected either '" + std::string(a) + " = ...' or '" +
                                         std::string(b) + " = ...'");
    }
    return reader.has(a) ? a : b;
}

std::optional<Vec3> read_direction(BlockReader& reader, const Vec3& origin,
                                   std::string_view point_key, std::string_view direction_key) {
    Vec3 point, direction;
    reader.ignore(point_key);
    reader.ignore(direction_key);
    const std::string_view key = require_one_of(reader, point_key, direction_key);
    if (key == point_key) {
        if (!reader.read(key, point)) return std::nullopt;
        direction = point - origin;
    } else if (!reader.read(key, direction)) {
        return std::nullopt;
    }
    if (length_squared(direction) > 0) return direction;
    reader.error(reader.block(), "'" + std::string(key) + "' gives no direction");
    return std::nullopt;
}

bool read_positive(BlockReader& reader, std::string_view key, double& out) {
    double value = 0;
    if (!reader.read(key, value)) return false;
    if (value > 0) {
        out = value;
        return true;
    }
    reader.error(reader.block(), "'" + std::string(key) + "' must be greater than 0");
    return false;
}

bool read_angle(BlockReader& reader, std::string_view degrees_key, std::string_view radians_key,
                double& radians) {
    double degrees = 0;
    if (reader.has(degrees_key) && reader.has(radians_key)) {
        reader.error(reader.block(), "'" + std::string(degrees_key) + "' and '" +
                                         std::string(radians_key) +
                                         "' exclude each other; expected one of them");
    }
    if (reader.read(degrees_key, degrees)) radians = degrees * kRadiansPerDegree;
    reader.read(radians_key, radians);
    return reader.has(degrees_key) || reader.has(radians_key);
}

}  // namespace alhazen
