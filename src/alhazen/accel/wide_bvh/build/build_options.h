#pragma once
/// How an accelerator is built, and how exactly it answers.

#include <cstdint>
#include <span>
#include <string>

namespace alhazen {

/// How much work goes into building. The hits are the same for all; what changes is how long
/// building and tracing take.
enum class BuildQuality : std::uint8_t {
    Fast,     ///< for what changes from picture to picture: clustering along a space-filling curve
    Default,  ///< binned surface area heuristic
    High,     ///< for what is traced for long: spatial splits, reinsertion
};

/// Which arithmetic decides whether a ray hits a triangle.
enum class Precision : std::uint8_t {
    Robust,  ///< double with exact signs: no leaks, the same bits as every other accelerator
    Fast,  ///< float where an accelerator has it: may leak at edges, parameters carry its rounding
};

/// What the leaves hold of a triangle.
enum class Leaves : std::uint8_t {
    Vertices,  ///< its vertices in float, eight triangles in five cache lines
    Indices,   ///< its number only: a fifth of the memory, and slower to trace
};

struct BuildOptions {
    BuildQuality quality = BuildQuality::Default;
    Precision precision = Precision::Robust;
    Leaves leaves = Leaves::Vertices;
    /// Children of a node: 4, 8 or 16; all give the same hits. Packets of coherent rays are there
    /// for 8 only, and so is Precision::Fast, which takes 8 whatever is said here.
    std::uint32_t width = 8;
};

/// Throws Error(Usage) for a width that no node has.
void check_node_width(std::uint32_t width);

struct BuildQualityEntry {
    const char* name;
    const char* description;  ///< one line
    BuildQuality quality;
};

/// In the order of the enumeration.
[[nodiscard]] std::span<const BuildQualityEntry> build_quality_table();
/// The one called `name`. Throws Error(Usage) with the valid names for an unknown one.
[[nodiscard]] BuildQuality find_build_quality(const std::string& name);
[[nodiscard]] const char* name_of(BuildQuality quality);

}  // namespace alhazen
