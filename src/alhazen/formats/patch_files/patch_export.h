#pragma once
/// Patches and NURBS surfaces as text of patch files: .bpt, and the free-form surfaces of OBJ.
///
/// Source: docs/reference/formats/bpt.md; "Object Files (.obj)", Wavefront, 1992.
/// Conventions: numbers are the shortest decimals that read back equal. A placement applies to the
/// control points, which is exact up to rounding; a mirroring one also reverses u (patches from u
/// to 1 - u, knots and loops from u to -u), so that the outside stays outside. The identity keeps
/// all bits.

#include <span>
#include <string>

#include "alhazen/math/affine.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

/// A surface as an object of a file.
struct NamedSurface {
    std::string name;
    const AnyShape* shape = nullptr;  ///< never null
    Affine placement;                 ///< file_from_shape
    std::string material;             ///< OBJ: name for `usemtl`; empty: none
};

/// True if a placement turns the outside in: u of the surface is then written in reverse.
[[nodiscard]] bool is_mirroring(const Affine& placement);

/// True for Bezier patches, patch meshes and bilinear patches; .bpt has no weights other than 1.
[[nodiscard]] bool fits_bpt(const AnyShape& shape);
/// True for the shapes of .bpt with any weights, and NURBS surfaces with their trimming loops.
[[nodiscard]] bool fits_obj_surface(const AnyShape& shape);

/// Number of control points of a shape that fits; 0 for others.
[[nodiscard]] std::size_t control_points_of(const AnyShape& shape);

/// All patches of the surfaces. Precondition: fits_bpt for each.
[[nodiscard]] std::string bpt_text(std::span<const NamedSurface> surfaces);
/// Text with one `o` per surface, all of different names; indices are relative, so that the text
/// may follow any other. Trimming loops are written in order: the first as the outer one, all
/// others as holes, which is odd-even nesting of one level.
[[nodiscard]] std::string obj_surfaces_text(std::span<const NamedSurface> surfaces);

}  // namespace alhazen
