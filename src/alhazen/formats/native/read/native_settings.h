#pragma once
/// The `picture` and `conventions` blocks of the native format.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

void read_picture(const NativeBlock& block, NativeContext& context);
void read_environment(const NativeBlock& block, NativeContext& context);
void read_conventions(const NativeBlock& block, NativeContext& context);

}  // namespace alhazen
