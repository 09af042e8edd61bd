#include "alhazen/shapes/shape_list.h"

namespace alhazen {

AnyShape::AnyShape() = default;
AnyShape::AnyShape(const AnyShape&) = default;
AnyShape::AnyShape(AnyShape&&) noexcept = default;
AnyShape& AnyShape::operator=(const AnyShape&) = default;
AnyShape& AnyShape::operator=(AnyShape&&) noexcept = default;
AnyShape::~AnyShape() = default;

}  // namespace alhazen
