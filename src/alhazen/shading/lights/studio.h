#pragma once
/// A neutral studio as a picture of all directions: lamps with soft boxes before grey walls.
///
/// What metals and glass look like is what they mirror: large bright shapes with soft edges, a
/// graded grey between them, and a darker floor. A white matt surface is about as bright from all
/// sides as white paper should be.
/// Conventions: the frame of DirectionPicture; the viewer looks to the front, and the main lamp is
/// above the left shoulder.

#include "alhazen/imaging/image/image.h"

namespace alhazen {

[[nodiscard]] Image studio_picture();

}  // namespace alhazen
