#pragma once
/// Cameras and lights of the native format.

#include <span>
#include <string_view>

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// A block of the top level: a camera, a light or settings.
struct NativeTopBlock {
    std::string_view name;
    void (*read)(const NativeBlock&, NativeContext&);
};

/// The blocks of all alternatives of `Camera`, then of `Light`, in the order of the variants.
[[nodiscard]] std::span<const NativeTopBlock> native_view_blocks();

/// Gives cameras without an aspect that of the image. Call after the last block.
void complete_cameras(NativeContext& context);

}  // namespace alhazen
