#pragma once
/// Lights of the native format.

#include <span>

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// The blocks of all alternatives of `Light`, in the order of the variant.
[[nodiscard]] std::span<const NativeTopBlock> native_light_blocks();

}  // namespace alhazen
