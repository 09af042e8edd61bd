#pragma once
/// Writes a scene description as a file of the native format, with meshes and pictures in separate
/// files.
///
/// Conventions: `NativeImporter` reads back the same description: every number, name, order and
/// index, so that it renders to the same bits. Not kept: locations in the original files, `format`
/// and `path`, the names of animations (a single time is written), material numbers of parts that
/// place objects, channels of inputs without a texture, and derived fields of shapes. Blocks are
/// labelled by names, made unique where the grammar requires it; `name` then holds the original.

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Writes one file, given its name relative to the scene file and its bytes. Returns the name used,
/// which differs if the name is taken.
using NativeFileSink =
    std::function<std::string(const std::string& name, std::span<const std::byte>)>;

/// The text of the scene. `folder` is the folder of its other files, relative to the scene and
/// without a final slash; each file is passed to `write_beside`: meshes as binary PLY, pictures as
/// PNG (8 or 16 bits) or float EXR. Meshes of at most 16 triangles without normals and other
/// attributes are written inline. Precondition: `description` is valid. Throws Error (Scene) for
/// non-finite numbers, and the errors of `write_beside`.
[[nodiscard]] std::string native_scene_text(const SceneDescription& description,
                                            const std::string& folder,
                                            const NativeFileSink& write_beside);

/// The block of a single camera. Throws Error (Scene) for non-finite numbers.
[[nodiscard]] std::string native_camera_text(const CameraDescription& camera);

/// The block of a single light; a profile keeps the name of its file. Throws Error (Scene) for
/// non-finite numbers.
[[nodiscard]] std::string native_light_text(const LightDescription& light);

}  // namespace alhazen
