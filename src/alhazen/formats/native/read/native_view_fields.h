#pragma once
/// What the blocks of cameras and of lights share: fields, and a table by the alternatives of a
/// variant.

#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Requires exactly one of the keys; returns it.
[[nodiscard]] std::string_view require_one_of(BlockReader& reader, std::string_view a,
                                              std::string_view b);

/// The vector from `origin` to a point, or a direction; nothing, after an error, when it is zero.
[[nodiscard]] std::optional<Vec3> read_direction(BlockReader& reader, const Vec3& origin,
                                                 std::string_view point_key,
                                                 std::string_view direction_key);

/// True when it is present and greater than 0.
bool read_positive(BlockReader& reader, std::string_view key, double& out);

/// An angle in degrees or, for an exact value, in radians; true when it is present.
bool read_angle(BlockReader& reader, std::string_view degrees_key, std::string_view radians_key,
                double& radians);

/// The blocks of all alternatives, in the order of the variant, by `blocks_of(std::type_identity)`
/// of each.
template <class... Alternatives, class BlocksOf>
[[nodiscard]] std::vector<NativeTopBlock> blocks_of_all(
    std::type_identity<std::variant<Alternatives...>>, BlocksOf&& blocks_of) {
    std::vector<NativeTopBlock> blocks;
    const auto append = [&](const std::vector<NativeTopBlock>& more) {
        blocks.insert(blocks.end(), more.begin(), more.end());
    };
    (append(blocks_of(std::type_identity<Alternatives>{})), ...);
    return blocks;
}

}  // namespace alhazen
