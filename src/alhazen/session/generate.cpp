#include "alhazen/session/generate.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/session/generated_solids.h"

namespace alhazen {

namespace {

constexpr std::array kGenerators{
    GeneratorEntry{"perforated_plate", "holes", "one plate without SIZE cylinders",
                   &perforated_plate},
    GeneratorEntry{"menger_sponge", "leaves",
                   "a cube without square bars, of the first level with SIZE leaves",
                   &menger_sponge},
    GeneratorEntry{"drilled_spheres", "spheres", "SIZE spheres, each without a cylinder",
                   &drilled_spheres}};

}  // namespace

std::span<const GeneratorEntry> generators() {
    return kGenerators;
}

SceneDescription generate(const std::string& name, std::uint64_t size) {
    if (size < 1 || size > kMaxGeneratedSize) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--size {}: expected 1 to {}", size, kMaxGeneratedSize));
    }
    std::string names;
    for (const GeneratorEntry& entry : generators()) {
        if (name == entry.name) return entry.make(size);
        names += names.empty() ? "" : ", ";
        names += entry.name;
    }
    throw Error(ErrorKind::Usage,
                fmt::format("no generated scene '{}'; the valid names are: {}", name, names));
}

}  // namespace alhazen
