#pragma once
/// The header of a PLY file: which elements follow, and what each is made of.
///
/// Source: Turk, "The PLY Polygon File Format", Stanford, 1994.
/// Differs: the newer names of the types (float32, uint8, ...) are known too; lines that are no
/// statement (old exporters write their name without `comment`) are stepped over with a warning.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/diagnostics.h"

namespace alhazen {

/// A comment by which our own files say that their arrays are to be taken as they are.
inline constexpr std::string_view kPlyExact = "alhazen exact";

enum class PlyFormat { Ascii, LittleEndian, BigEndian };
enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

/// Size in a binary file.
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

    /// The fewest bytes an item can take; 0 only without properties.
    [[nodiscard]] std::size_t min_bytes(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;
    bool exact = false;           ///< has the comment kPlyExact
    std::size_t body_offset = 0;  ///< bytes before the first item
    std::int64_t body_line = 1;   ///< its line
};

/// Reads the header. Empty after an error, which is in `diagnostics`.
[[nodiscard]] std::optional<PlyHeader> read_ply_header(std::string_view bytes,
                                                       const std::string& file,
                                                       Diagnostics& diagnostics);

}  // namespace alhazen
