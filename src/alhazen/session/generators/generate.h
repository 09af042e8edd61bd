#pragma once
/// Generated scenes of any size by name, for measurements and pictures: `alhazen generate`.
///
/// Conventions: each generator defines the unit of its size, and whether the size is exact or a
/// minimum. All scenes have a camera and lights. The same name and size give the same scene on
/// every machine, up to the last bits of the sines of the C library.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "alhazen/scene_model/scene_description.h"
#include "alhazen/session/generators/nff_text.h"

namespace alhazen {

struct GeneratorEntry {
    const char* name;
    const char* size;            ///< unit of the size, one word
    std::uint64_t default_size;  ///< for a database the published one
    std::uint64_t max_size;
    const char* description;  ///< one line
    /// Exactly one of the two is set: a function that returns a description, or one that returns
    /// the text of an NFF file.
    SceneDescription (*make)(std::uint64_t size);
    void (*write_nff)(std::uint64_t size, NffText& out);
};

/// ADD A SCENE in generate.cpp: one entry of this table.
[[nodiscard]] std::span<const GeneratorEntry> generators();

/// Throws Error (Usage) with the valid names for an unknown one.
[[nodiscard]] const GeneratorEntry& find_generator(const std::string& name);

/// The generated scene, valid; for a database the scene of its NFF file with six digits. Throws
/// Error: Usage as above, and for a size of 0 or above the generator's largest.
[[nodiscard]] SceneDescription generate(const std::string& name,
                                        std::optional<std::uint64_t> size = {});

/// The NFF file of a database. `digits`: significant digits of its numbers, 1 to 17. Throws Error:
/// Usage as above, and for a scene that NFF cannot hold.
[[nodiscard]] std::string generate_nff(const std::string& name,
                                       std::optional<std::uint64_t> size = {},
                                       int digits = NffText::kPublishedDigits);

}  // namespace alhazen
