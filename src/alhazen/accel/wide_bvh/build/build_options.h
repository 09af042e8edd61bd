#pragma once
/// Options of accelerators: build quality, precision, and layout of leaves and nodes.

#include <cstdint>
#include <span>
#include <string>

namespace alhazen {

/// Build effort. Hits are the same for all; build and trace times differ.
enum class BuildQuality : std::uint8_t {
    Fast,     ///< for scenes that change with every image: divides a space-filling curve
    Default,  ///< binned surface area heuristic
    High,     ///< for scenes that are traced often: spatial splits, reinsertion
};

/// The arithmetic of the ray-triangle test.
enum class Precision : std::uint8_t {
    Robust,  ///< double with exact signs: no leaks, the same bits as every other accelerator
    Fast,    ///< float where an accelerator supports it: may leak at edges, parameters have float
           ///< precision; a leaving_ray misses the triangle that it leaves, unless that is thinner
           ///< than 2^-20 of the largest coordinate of the accelerator's geometry (measured)
};

/// The representation of triangles in the leaves.
enum class Leaves : std::uint8_t {
    Vertices,  ///< vertices in float, eight triangles in five cache lines
    Indices,   ///< triangle indices only: a fifth of the memory, and slower to trace
};

struct BuildOptions {
    BuildQuality quality = BuildQuality::Default;
    Precision precision = Precision::Robust;
    Leaves leaves = Leaves::Vertices;
    /// Children per node: 4, 8 or 16; all give the same hits. Packets of coherent rays and
    /// Precision::Fast exist for 8 only; Precision::Fast uses 8 regardless of this value.
    std::uint32_t width = 8;
};

/// Throws Error(Usage) for a width that is not supported.
void check_node_width(std::uint32_t width);

struct BuildQualityEntry {
    const char* name;
    const char* description;  ///< one line
    BuildQuality quality;
};

[[nodiscard]] std::span<const BuildQualityEntry> build_quality_table();
/// The entry with this name. Throws Error(Usage) with the valid names for an unknown one; `also`
/// is another name that the caller takes, empty for none.
[[nodiscard]] BuildQuality find_build_quality(const std::string& name, std::string also = {});
[[nodiscard]] const char* name_of(BuildQuality quality);

}  // namespace alhazen
