#pragma once
/// The `picture` and `conventions` blocks of the native format.

#include "alhazen/importers/native/native_context.h"

namespace alhazen {

void read_picture(const NativeBlock& block, NativeContext& context);
void read_conventions(const NativeBlock& block, NativeContext& context);

/// What holds where a native scene says nothing.
[[nodiscard]] ShadingConventions native_conventions();

}  // namespace alhazen
