#pragma once
/// Scenes of any size by name, to measure and to look at: `alhazen generate`.
///
/// Conventions: what a size counts is the generator's; the scene has a camera, lights and at least
/// that size. The same name and size give the same scene on every machine. z is up.

#include <cstdint>
#include <span>
#include <string>

#include "alhazen/scene/scene_description.h"

namespace alhazen {

struct GeneratorEntry {
    const char* name;
    const char* size;         ///< what its size counts, one word
    const char* description;  ///< one line
    SceneDescription (*make)(std::uint64_t size);
};

/// ADD A SCENE in generate.cpp: one entry of this table.
[[nodiscard]] std::span<const GeneratorEntry> generators();

/// The scene, valid. Throws Error: Usage with the valid names for an unknown one, and for a size of
/// 0 or above kMaxGeneratedSize.
[[nodiscard]] SceneDescription generate(const std::string& name, std::uint64_t size);
inline constexpr std::uint64_t kMaxGeneratedSize = 100'000'000;

}  // namespace alhazen
