#include "alhazen/accel/directions/ray_coherence.h"

namespace alhazen {

RayCoherence::Config RayCoherence::configure(SettingsReader& reader) {
    Config config;
    config.resolution = reader.count(
        "resolution",
        "cells along an edge of the cube of directions, 0: by the number of primitives", 0, 0, 64);
    config.most = reader.count("most", "with more primitives the fallback traces all rays", 20000,
                               0, 1000000);
    config.memory_mib =
        reader.count("memory_mib", "memory of lists; then no more are made", 256, 0, 1 << 20);
    config.others = FallbackAccelerator::configure(reader);
    return config;
}

RayCoherence RayCoherence::build(const BoundsSource& source, const Config& config) {
    RayCoherence made;
    made.others_ = FallbackAccelerator(source, config.others);
    if (source.size() == 0 || source.size() > static_cast<std::size_t>(config.most)) return made;
    made.space_ = PaddedBox(source);
    made.ends_ = RayEndFinder(source, made.space_, 1000);
    made.lists_ = std::make_unique<CoherenceLists>(
        source, made.ends_.places(), made.space_.pad, config.resolution,
        static_cast<std::size_t>(config.memory_mib) << 20);
    return made;
}

}  // namespace alhazen
