#pragma once
/// Materials and textures of the native format.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

void read_native_material(const NativeBlock& block, NativeContext& context);
void read_native_solid_texture(const NativeBlock& block, NativeContext& context);
void read_native_texture(const NativeBlock& block, NativeContext& context,
                         const NativeScope& scope);

/// Reads a colour, or one number for a grey.
bool read_native_color(TextNode value, std::string_view key, const ValueReader& values, Rgb& out);

/// The material that `value` names or describes; none, after an error, if it does neither.
[[nodiscard]] std::optional<MaterialId> read_material_value(TextNode value, NativeContext& context);
/// The value of `material = ...` of a part; if it is absent or invalid, the default of `scope`, or
/// else the built-in grey.
[[nodiscard]] MaterialId read_part_material(BlockReader& reader, NativeContext& context,
                                            const NativeScope& scope);

}  // namespace alhazen
