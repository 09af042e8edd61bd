#pragma once
/// Cameras and lights of the native format.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

void read_perspective_camera(const NativeBlock& block, NativeContext& context);
void read_sheared_camera(const NativeBlock& block, NativeContext& context);
void read_orthographic_camera(const NativeBlock& block, NativeContext& context);
void read_sheared_orthographic_camera(const NativeBlock& block, NativeContext& context);

void read_ambient_light(const NativeBlock& block, NativeContext& context);
void read_directional_light(const NativeBlock& block, NativeContext& context);
void read_point_light(const NativeBlock& block, NativeContext& context);
void read_spot_light(const NativeBlock& block, NativeContext& context);

/// Gives the cameras without an aspect of their own that of the picture. Call when all is read.
void complete_cameras(NativeContext& context);

}  // namespace alhazen
