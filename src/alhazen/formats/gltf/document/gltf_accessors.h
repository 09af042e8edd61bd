#pragma once
/// The layout of accessors in memory and walks over their elements.
///
/// Source: "glTF 2.0 Specification", 2021, sections 3.6.2.3 to 3.6.2.5.
/// Differs: the last column of a matrix need not be padded, nor the last element of a stride.

#include <cstdint>

#include "alhazen/formats/gltf/document/gltf_document.h"

namespace alhazen::gltf {

/// Bytes of a component: 1, 2 or 4.
[[nodiscard]] std::size_t component_size(ComponentType type);
[[nodiscard]] const char* name_of(ComponentType type);  ///< "UNSIGNED_BYTE"
[[nodiscard]] const char* name_of(ElementType type);    ///< "VEC3"

/// How the components of an element lie: `columns` runs of `rows` components, `column_stride` bytes
/// apart. One column for everything but matrices, whose columns begin at multiples of 4.
struct ElementLayout {
    std::size_t rows = 1, columns = 1;
    std::size_t component = 4;      ///< bytes
    std::size_t column_stride = 4;  ///< bytes
    std::size_t size = 4;           ///< bytes from the first component to the end of the last
    std::size_t packed = 4;         ///< distance of elements that are packed tightly
};
[[nodiscard]] ElementLayout layout_of(ComponentType component, ElementType type);

/// A run of elements in memory; `data` is null for zeros.
struct ElementRun {
    const char* data = nullptr;
    std::size_t stride = 0;
    std::uint64_t first = 0, count = 0;  ///< which elements of the accessor they are
};

/// The base elements of an accessor, without its sparse ones; and the sparse ones, of which
/// element i belongs at `sparse_index(document, accessor, i)`.
[[nodiscard]] ElementRun base_run(const Document& document, const Accessor& accessor);
[[nodiscard]] ElementRun sparse_run(const Document& document, const Accessor& accessor);
[[nodiscard]] std::uint64_t sparse_index(const Document& document, const Accessor& accessor,
                                         std::uint64_t i);

/// Calls f(run) for the pieces that the accessor's elements consist of after the sparse ones are
/// put in place, in order. Needs ascending sparse indices.
template <class F>
void each_run(const Document& document, const Accessor& accessor, F&& f) {
    const ElementRun base = base_run(document, accessor);
    const auto piece = [&](std::uint64_t from, std::uint64_t to) {
        if (from >= to) return;
        ElementRun run = base;
        run.first = from;
        run.count = to - from;
        if (run.data != nullptr) run.data += from * base.stride;
        f(run);
    };
    if (!accessor.sparse) return piece(0, accessor.count);
    const ElementRun values = sparse_run(document, accessor);
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < values.count; ++i) {
        const std::uint64_t at = sparse_index(document, accessor, i);
        if (at >= accessor.count) break;  // only the first elements are asked for
        piece(next, at);
        f(ElementRun{values.data + i * values.stride, values.stride, at, 1});
        next = at + 1;
    }
    piece(next, accessor.count);
}

}  // namespace alhazen::gltf
