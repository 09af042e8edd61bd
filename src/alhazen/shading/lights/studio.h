#pragma once
/// A neutral studio as a picture of all directions: lights with soft boxes in front of grey walls.
///
/// Metals and glass mirror large bright shapes with soft edges, a graded grey in between, and a
/// darker floor. A white matt surface has about the brightness of white paper from all sides.
/// Conventions: the frame of DirectionPicture; the viewer faces the front, and the main light is
/// above the left shoulder.

#include "alhazen/imaging/image/image.h"

namespace alhazen {

[[nodiscard]] Image studio_picture();

}  // namespace alhazen
