#include "alhazen/accel/wide_bvh/build/build_options.h"

#include <utility>

#include "alhazen/base/error.h"

namespace alhazen {
namespace {

constexpr BuildQualityEntry kEntries[] = {
    {"fast", "neighbors on a Morton curve share a leaf: several times faster to build",
     BuildQuality::Fast},
    {"default", "binned surface area heuristic", BuildQuality::Default},
    {"high", "spatial splits and reinsertion: several times slower to build, faster to trace",
     BuildQuality::High},
};

}  // namespace

std::span<const BuildQualityEntry> build_quality_table() {
    return kEntries;
}

BuildQuality find_build_quality(const std::string& name, std::string also) {
    std::string names = std::move(also);
    for (const BuildQualityEntry& entry : kEntries) {
        if (name == entry.name) return entry.quality;
        names += names.empty() ? "" : ", ";
        names += entry.name;
    }
    throw Error(ErrorKind::Usage, "no build quality '" + name + "'; the valid names are: " + names);
}

void check_node_width(std::uint32_t width) {
    if (width == 4 || width == 8 || width == 16) return;
    throw Error(ErrorKind::Usage, "nodes have 4, 8 or 16 children, not " + std::to_string(width));
}

const char* name_of(BuildQuality quality) {
    return kEntries[static_cast<std::size_t>(quality)].name;
}

}  // namespace alhazen
