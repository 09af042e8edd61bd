#include "alhazen/session/generators/generate.h"

#include <fmt/format.h>

#include <array>

#include "alhazen/base/error.h"
#include "alhazen/formats/nff/nff_importer.h"
#include "alhazen/session/generators/city.h"
#include "alhazen/session/generators/field.h"
#include "alhazen/session/generators/generated_solids.h"
#include "alhazen/session/generators/spd.h"
#include "alhazen/session/generators/stress_scenes.h"

namespace alhazen {

namespace {

constexpr std::uint64_t kMillion = 1'000'000;

constexpr std::array kGenerators{
    GeneratorEntry{"balls", "levels", 4, 7,
                   "SPD: a ball with nine on it, each with nine on it, ...", nullptr, &write_balls},
    GeneratorEntry{"gears", "gears", 4, 40, "SPD: meshing gears, SIZE along each side of a cube",
                   nullptr, &write_gears},
    GeneratorEntry{"jacks", "levels", 3, 7,
                   "SPD: a jack with eight smaller ones in its corners, ...", nullptr,
                   &write_jacks},
    GeneratorEntry{"lattice", "cells", 12, 150, "SPD: balls and rods, SIZE cells along each side",
                   nullptr, &write_lattice},
    GeneratorEntry{"mount", "levels", 6, 11, "SPD: a fractal mountain and four balls of glass",
                   nullptr, &write_mount},
    GeneratorEntry{"rings", "layers", 7, 80, "SPD: a pyramid of knots of linked rings", nullptr,
                   &write_rings},
    GeneratorEntry{"shells", "quarters", 4, 100'000, "SPD: a snail shell of 90 SIZE + 1 balls",
                   nullptr, &write_shells},
    GeneratorEntry{"sombrero", "levels", 2, 7, "SPD: a rippled surface", nullptr, &write_sombrero},
    GeneratorEntry{"teapot", "cells", 12, 400, "SPD: Newell's teapot, SIZE cells along each patch",
                   nullptr, &write_teapot},
    GeneratorEntry{"tetra", "levels", 6, 11, "SPD: Sierpinski's tetrahedron", nullptr,
                   &write_tetra},
    GeneratorEntry{"tree", "levels", 11, 21, "SPD: a tree that forks SIZE times", nullptr,
                   &write_tree},
    GeneratorEntry{"stadium", "triangles", kMillion, 50 * kMillion,
                   "a teapot of SIZE triangles in a stadium of SIZE triangles", &stadium, nullptr},
    GeneratorEntry{"thin_sticks", "sticks", 10'000, 10 * kMillion,
                   "SIZE long thin cylinders in all directions", &thin_sticks, nullptr},
    GeneratorEntry{"coincident_clusters", "spheres", 10'000, 10 * kMillion,
                   "SIZE spheres in heaps of 64 with one centre", &coincident_clusters, nullptr},
    GeneratorEntry{"city", "houses", 10'000, 10 * kMillion,
                   "SIZE boxes on a square of ground, every fourth a mirror", &city, nullptr},
    GeneratorEntry{"field", "triangles", 2000 * kMillion, 100 * kMillion* kMillion,
                   "a meadow of SIZE triangles or a little more, instances of instances of 4000",
                   &field, nullptr},
    GeneratorEntry{"field_of_grids", "triangles", 2000 * kMillion, 100 * kMillion* kMillion,
                   "the same as grids in grids, put together by hand", &field_of_grids, nullptr},
    GeneratorEntry{"perforated_plate", "holes", 1000, 100 * kMillion,
                   "one plate without SIZE cylinders", &perforated_plate, nullptr},
    GeneratorEntry{"menger_sponge", "leaves", 1000, 100 * kMillion,
                   "a cube without square bars, of the first level with SIZE leaves",
                   &menger_sponge, nullptr},
    GeneratorEntry{"drilled_spheres", "spheres", 1000, 100 * kMillion,
                   "SIZE spheres, each without a cylinder", &drilled_spheres, nullptr}};

std::uint64_t size_of(const GeneratorEntry& entry, std::optional<std::uint64_t> size) {
    const std::uint64_t n = size.value_or(entry.default_size);
    if (n < 1 || n > entry.max_size) {
        throw Error(ErrorKind::Usage, fmt::format("--size {} of {} ({}): expected 1 to {}", n,
                                                  entry.name, entry.size, entry.max_size));
    }
    return n;
}

SceneDescription read_nff(const std::string& text) {
    const ImportOptions options;
    Diagnostics diagnostics;
    SceneDescription scene = NffImporter().import({text, {}, options}, diagnostics);
    diagnostics.throw_if_errors();
    return scene;
}

}  // namespace

std::span<const GeneratorEntry> generators() {
    return kGenerators;
}

const GeneratorEntry& find_generator(const std::string& name) {
    std::string names;
    for (const GeneratorEntry& entry : generators()) {
        if (name == entry.name) return entry;
        names += names.empty() ? "" : ", ";
        names += entry.name;
    }
    throw Error(ErrorKind::Usage,
                fmt::format("no generated scene '{}'; the valid names are: {}", name, names));
}

SceneDescription generate(const std::string& name, std::optional<std::uint64_t> size) {
    const GeneratorEntry& entry = find_generator(name);
    if (entry.write_nff != nullptr) return read_nff(generate_nff(name, size));
    return entry.make(size_of(entry, size));
}

std::string generate_nff(const std::string& name, std::optional<std::uint64_t> size, int digits) {
    const GeneratorEntry& entry = find_generator(name);
    const std::uint64_t n = size_of(entry, size);
    if (entry.write_nff == nullptr) {
        throw Error(ErrorKind::Usage,
                    fmt::format("{} is no database of NFF; expected a name that ends in .alhazen",
                                entry.name));
    }
    if (digits < 1 || digits > 17) {
        throw Error(ErrorKind::Usage, fmt::format("--digits {}: expected 1 to 17", digits));
    }
    NffText text(digits);
    entry.write_nff(n, text);
    return text.take();
}

}  // namespace alhazen
