#pragma once
/// Blocks of the quadrics, the torus and the algebraic surfaces.
///
/// Source: docs/reference/formats/native.md. Differs: nothing. Conventions: internal to this
/// folder; keys are the names of the structs' fields, and what a file leaves out keeps the struct's
/// default.

#include "alhazen/formats/native/read/native_text.h"
#include "alhazen/formats/text/block_reader.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

AnyShape read_native_ellipsoid(BlockReader& reader);
AnyShape read_native_elliptic_cylinder(BlockReader& reader);
AnyShape read_native_elliptic_cone(BlockReader& reader);
AnyShape read_native_tgc(BlockReader& reader);
AnyShape read_native_torus(BlockReader& reader);
AnyShape read_native_paraboloid(BlockReader& reader);
AnyShape read_native_hyperboloid(BlockReader& reader);
AnyShape read_native_two_sheet_hyperboloid(BlockReader& reader);
AnyShape read_native_quadric(BlockReader& reader);
AnyShape read_native_algebraic(BlockReader& reader);
AnyShape read_native_superellipsoid(BlockReader& reader);

void add_fields(NativeBlockText& block, const Ellipsoid& s);
void add_fields(NativeBlockText& block, const EllipticCylinder& s);
void add_fields(NativeBlockText& block, const EllipticCone& s);
void add_fields(NativeBlockText& block, const Tgc& s);
void add_fields(NativeBlockText& block, const Torus& s);
void add_fields(NativeBlockText& block, const Paraboloid& s);
void add_fields(NativeBlockText& block, const Hyperboloid& s);
void add_fields(NativeBlockText& block, const TwoSheetHyperboloid& s);
void add_fields(NativeBlockText& block, const Quadric& s);
void add_fields(NativeBlockText& block, const Algebraic& s);
void add_fields(NativeBlockText& block, const Superellipsoid& s);

}  // namespace alhazen
