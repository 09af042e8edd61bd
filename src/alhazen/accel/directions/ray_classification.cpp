#include "alhazen/accel/directions/ray_classification.h"

namespace alhazen {

RayClassification::Config RayClassification::configure(SettingsReader& reader) {
    Config config;
    config.leaf_size = static_cast<std::size_t>(
        reader.count("leaf_size", "classes with more candidates are divided", 8, 1, 1000000));
    config.max_depth = reader.count("max_depth", "maximum number of halvings of a class", 8, 0, 16);
    config.memory_bytes =
        static_cast<std::size_t>(reader.count(
            "memory_mib", "memory of classes; then all are discarded", 256, 0, 1 << 20))
        << 20;
    return config;
}

}  // namespace alhazen
