#pragma once
/// Fields that blocks of cameras and lights share, and a table by the alternatives of a variant.

#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Returns the one key that is present; an error if none or both are.
[[nodiscard]] std::string_view require_one_of(BlockReader& reader, std::string_view a,
                                              std::string_view b);

/// The vector from `origin` to a point, or a direction; none, after an error, if it is zero.
[[nodiscard]] std::optional<Vec3> read_direction(BlockReader& reader, const Vec3& origin,
                                                 std::string_view point_key,
                                                 std::string_view direction_key);

/// True if the key is present and its value greater than 0.
bool read_positive(BlockReader& reader, std::string_view key, double& out);

/// Reads an angle in degrees or, for an exact value, in radians; true if it is present.
bool read_angle(BlockReader& reader, std::string_view degrees_key, std::string_view radians_key,
                double& radians);

/// The blocks of all alternatives, in the order of the variant; `blocks_of(std::type_identity)`
/// gives those of one.
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
