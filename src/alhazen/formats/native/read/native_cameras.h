#pragma once
/// Cameras of the native format.

#include <span>

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// The blocks of all alternatives of `Camera`, in the order of the variant.
[[nodiscard]] std::span<const NativeTopBlock> native_camera_blocks();

/// Gives cameras without an aspect ratio that of the image. To be called after the last block.
void complete_cameras(NativeContext& context);

}  // namespace alhazen
