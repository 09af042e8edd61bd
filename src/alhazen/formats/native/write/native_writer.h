#pragma once
/// A scene description as a file of the native format, with meshes and pictures in files beside it.
///
/// Conventions: `NativeImporter` reads back the same description: every number, name, order and
/// index, so that it renders to the same bits. What is not kept: places in the old files, `format`
/// and `path`, the names of animations (one moment of them is written), material numbers of parts
/// that place objects, channels of inputs without a texture, and derived fields of shapes. Blocks
/// are labelled by the names of things, made unique where the grammar asks for it; `name` then
/// tells the real one.

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Takes one file: its name relative to the scene file, and its bytes. Returns the name that it
/// got, which may be another one where that is taken.
using NativeFileSink =
    std::function<std::string(const std::string& name, std::span<const std::byte>)>;

/// The text of the scene. `folder` is where the scene will name its other files, relative to itself
/// and without a slash at the end; each is handed to `write_beside`, meshes as binary PLY, pictures
/// as PNG (8 or 16 bits) or float EXR. Meshes of at most 16 triangles without normals and the like
/// are written out in the text. `description` must be valid. Throws Error (Scene) for numbers that
/// are not finite, and what `write_beside` throws.
[[nodiscard]] std::string native_scene_text(const SceneDescription& description,
                                            const std::string& folder,
                                            const NativeFileSink& write_beside);

}  // namespace alhazen
