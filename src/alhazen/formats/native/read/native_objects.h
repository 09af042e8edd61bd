#pragma once
/// Objects of the native format, the list that numbers them, and their instances.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads `objects { names = [...]; root = "..." }`: the objects in the order of their numbers.
void read_native_object_list(const NativeBlock& block, NativeContext& context, NativeScope& scope);
void read_native_object(const NativeBlock& block, NativeContext& context, NativeScope& scope);
/// Reads `union { ... }`, `intersection { ... }` or `difference { ... }`: an object that is one
/// solid, and the part that places it.
void read_native_solid(const NativeBlock& block, NativeContext& context, NativeScope& scope);
/// Reads `instance "object" { transform = ... }` or `instance "object";`.
void read_native_instance(TextNode entry, NativeContext& context, NativeScope& scope);

/// Reports objects that are listed but not defined. To be called after the last item.
void check_listed_objects(NativeContext& context);

}  // namespace alhazen
