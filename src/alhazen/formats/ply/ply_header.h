#pragma once
/// The header of a PLY file: its elements and their properties.
///
/// Source: Turk, "The PLY Polygon File Format", Stanford, 1994.
/// Differs: accepts the newer type names (float32, uint8, ...); lines that are not statements (old
/// exporters write their name without `comment`) are skipped with a warning.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/diagnostics.h"

namespace alhazen {

/// The comment of PLY files of this library, whose arrays are read unchanged.
inline constexpr std::string_view kPlyExact = "alhazen exact";

enum class PlyFormat { Ascii, LittleEndian, BigEndian };
enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

/// Size in bytes in a binary file.
[[nodiscard]] std::size_t size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    std::optional<PlyType> count_type;  ///< set for a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    FileLocation location;

    /// Minimum bytes per item; 0 only without properties.
    [[nodiscard]] std::size_t min_bytes(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;
    bool exact = false;           ///< has the comment kPlyExact
    std::size_t body_offset = 0;  ///< offset of the first item in bytes
    std::int64_t body_line = 1;   ///< line of the first item
};

/// Reads the header; none after an error, which is reported to `diagnostics`.
[[nodiscard]] std::optional<PlyHeader> read_ply_header(std::string_view bytes,
                                                       const std::string& file,
                                                       Diagnostics& diagnostics);

}  // namespace alhazen
