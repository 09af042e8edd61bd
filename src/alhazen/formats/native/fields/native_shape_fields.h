#pragma once
/// Text of the fields of shapes (shapes/core/fields.h) in the native format, reading and writing.
///
/// Source: docs/reference/formats/native.md.
/// Conventions: keys are the names of the fields; an absent key keeps the default of the struct.
/// Fields of basic types need no code. ADD A FIELD of another type here: `read_native_field` and
/// `native_field_text` for its type. A shape whose text is not one pair per field has its own
/// `read_native_fields` and `write_native_fields`. Internal to the native format.

#include "alhazen/formats/native/fields/native_text.h"
#include "alhazen/formats/text/block_reader.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

// ---- one field

void read_native_count(BlockReader& reader, std::string_view key, std::uint32_t& count);
void read_native_list(BlockReader& reader, std::string_view key, std::vector<Vec3>& list);
void read_native_list(BlockReader& reader, std::string_view key, std::vector<double>& list);
void read_native_list(BlockReader& reader, std::string_view key, std::vector<std::uint32_t>& list);
void read_native_list(BlockReader& reader, std::string_view key, std::vector<TrimLoop>& list);

template <class S, class T>
void read_native_field(BlockReader& reader, const Field<S, T>& field, S& shape) {
    reader.read(field.name, shape.*field.member);
}
/// A number or an index, at least 0.
template <class S>
void read_native_field(BlockReader& reader, const Field<S, std::uint32_t>& field, S& shape) {
    read_native_count(reader, field.name, shape.*field.member);
}
/// `[a, b, ...]`; loops of trimming curves: `[[polyline((u, v), ...), curve { ... }], ...]`.
template <class S, class T>
void read_native_field(BlockReader& reader, const Field<S, std::vector<T>>& field, S& shape) {
    read_native_list(reader, field.name, shape.*field.member);
}
/// `((x, y, z), (x, y, z))`: the lower and the upper corner.
void read_native_field(BlockReader& reader, const Field<Quadric, Box3>& field, Quadric& shape);
void read_native_field(BlockReader& reader, const Field<Algebraic, Box3>& field, Algebraic& shape);
/// `((x, y, z, offset), ...)`: removes the points p with dot((x, y, z), p) > offset.
void read_native_field(BlockReader& reader, const Field<Quadric, std::vector<ClipPlane>>& field,
                       Quadric& shape);
/// `profile = [(x, y), curve((x, y), (x, y), (x, y)), ...]` or `loops = [[...], ...]`. The loops of
/// a prism are closed.
void read_native_field(BlockReader& reader, const Field<Prism, Profile>& field, Prism& shape);
void read_native_field(BlockReader& reader, const Field<Lathe, Profile>& field, Lathe& shape);
/// `[sphere(center, radius, strength), cylinder(base, top, radius, strength), ...]`, required.
void read_native_field(BlockReader& reader, const Field<Blob, std::vector<BlobComponent>>& field,
                       Blob& shape);

template <class T>
[[nodiscard]] std::string native_field_text(const T& value) {
    return native_value(value);
}
[[nodiscard]] std::string native_field_text(const std::string& value);
[[nodiscard]] std::string native_field_text(const Box3& box);
[[nodiscard]] std::string native_field_text(std::uint32_t count);
[[nodiscard]] std::string native_field_text(const std::vector<Vec3>& list);
[[nodiscard]] std::string native_field_text(const std::vector<double>& list);
[[nodiscard]] std::string native_field_text(const std::vector<std::uint32_t>& list);
[[nodiscard]] std::string native_field_text(const std::vector<TrimLoop>& loops);
[[nodiscard]] std::string native_field_text(const std::vector<ClipPlane>& planes);
[[nodiscard]] std::string native_field_text(const Profile& profile);
[[nodiscard]] std::string native_field_text(const std::vector<BlobComponent>& components);

/// True if the value is the reader's default for an absent key.
template <class T>
[[nodiscard]] bool is_native_default(const T& value, const T& usual) {
    return native_field_text(value) == native_field_text(usual);
}
template <class T>
[[nodiscard]] bool is_native_default(const std::vector<T>& value, const std::vector<T>& usual) {
    return value.empty() && usual.empty();
}
/// True for an unbounded box, which cannot be written.
inline bool is_native_default(const Box3& box, const Box3&) {
    return !box.bounded();
}

template <class S, class T>
void write_native_field(NativeBlockText& block, const Field<S, T>& field, const S& shape) {
    const T& value = shape.*field.member;
    if (field.optional && is_native_default(value, S{}.*field.member)) return;
    block.add(field.name, native_field_text(value));
}
template <class S>
void write_native_field(NativeBlockText& block, const Field<S, Profile>& field, const S& shape) {
    block.add("loops", native_field_text(shape.*field.member));
}

// ---- all fields of a shape

template <class S>
void read_native_fields(BlockReader& reader, S& shape) {
    for_each_field<S>([&](const auto& field) { read_native_field(reader, field, shape); });
}
/// `vertices = (...)`, or `loops = ((...), ...)`.
void read_native_fields(BlockReader& reader, Polygon& shape);
/// `planes = ((point, normal), ...)`, or `vertices` and `faces`.
void read_native_fields(BlockReader& reader, Polyhedron& shape);
/// `heights` row by row and `columns`; for heights from an image see native_height_picture.h.
void read_native_fields(BlockReader& reader, HeightField& shape);

template <class S>
void write_native_fields(NativeBlockText& block, const S& shape) {
    for_each_field<S>([&](const auto& field) { write_native_field(block, field, shape); });
}
void write_native_fields(NativeBlockText& block, const Polygon& shape);
void write_native_fields(NativeBlockText& block, const Polyhedron& shape);
void write_native_fields(NativeBlockText& block, const HeightField& shape);

}  // namespace alhazen
