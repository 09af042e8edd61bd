#include "alhazen/accel/cells/octree.h"

#include <algorithm>
#include <bit>

namespace alhazen {

Octree::Config Octree::configure(SettingsReader& reader) {
    static constexpr const char* kWalks[] = {"point_location", "neighbor_finding", "smart",
                                             "parametric"};
    Config config;
    config.walk = static_cast<Walk>(reader.choice("walk", "traversal algorithm", 3, kWalks));
    config.max_depth =
        reader.count("max_depth", "depth of the tree", 8, 1, OctreeCells::kMostDepth);
    config.leaf_size =
        reader.count("leaf_size", "primitives in a cell that is not divided", 1, 1, 1000);
    config.mailbox = reader.flag("mailbox", "test a primitive in many cells once per ray", true);
    return config;
}

Octree Octree::build(const BoundsSource& source, const Config& config) {
    Octree made;
    made.config_ = config;
    made.primitives_ = static_cast<std::uint32_t>(source.size());
    const int full = static_cast<int>(std::bit_width(source.size()) + 2) / 3;
    const int depth = config.max_depth > 0 ? config.max_depth : std::min(full + 3, 12);
    made.cells_ = OctreeCells(source, depth, config.leaf_size);
    return made;
}

}  // namespace alhazen
