#pragma once
/// Smallest and largest stored value of each component of an accessor.
///
/// Source: "glTF 2.0 Specification", 2021, section 3.6.2.5 (accessor bounds).

#include <array>

#include "alhazen/formats/gltf/document/gltf_document.h"

namespace alhazen::gltf {

struct Extent {
    std::array<double, 16> min{}, max{};  ///< as stored: integers are not normalised
    bool is_finite = true;                ///< no component is NaN or infinite
};

/// Computes the extent in one pass over the elements; zeros for an accessor without data.
[[nodiscard]] Extent extent_of(const Document& document, const Accessor& accessor);

}  // namespace alhazen::gltf
