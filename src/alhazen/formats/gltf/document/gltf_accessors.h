#pragma once
/// Memory layout of accessors, and iteration over their elements.
///
/// Source: "glTF 2.0 Specification", 2021, sections 3.6.2.3 to 3.6.2.5.
/// Differs: padding after the last column of a matrix and after the last element is optional.

#include <cstdint>

#include "alhazen/formats/gltf/document/gltf_document.h"

namespace alhazen::gltf {

/// Size of a component in bytes: 1, 2 or 4.
[[nodiscard]] std::size_t component_size(ComponentType type);
[[nodiscard]] const char* name_of(ComponentType type);  ///< "UNSIGNED_BYTE"
[[nodiscard]] const char* name_of(ElementType type);    ///< "VEC3"

/// Layout of the components of an element: `columns` columns of `rows` components each,
/// `column_stride` bytes apart. Only matrices have several columns; these begin at multiples of 4.
struct ElementLayout {
    std::size_t rows = 1, columns = 1;
    std::size_t component = 4;      ///< bytes
    std::size_t column_stride = 4;  ///< bytes
    std::size_t size = 4;           ///< bytes from the first component to the end of the last
    std::size_t packed = 4;         ///< stride of tightly packed elements
};
[[nodiscard]] ElementLayout layout_of(ComponentType component, ElementType type);

/// A run of elements in memory; a null `data` stands for zeros.
struct ElementRun {
    const char* data = nullptr;
    std::size_t stride = 0;
    std::uint64_t first = 0, count = 0;  ///< range of element numbers in the accessor
};

/// The base elements of an accessor without its sparse substitution, and the sparse values. Sparse
/// value i replaces element `sparse_index(document, accessor, i)`.
[[nodiscard]] ElementRun base_run(const Document& document, const Accessor& accessor);
[[nodiscard]] ElementRun sparse_run(const Document& document, const Accessor& accessor);
[[nodiscard]] std::uint64_t sparse_index(const Document& document, const Accessor& accessor,
                                         std::uint64_t i);

/// Calls f(run) in order for the runs that make up the accessor after sparse substitution.
/// Requires ascending sparse indices.
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
        if (at >= accessor.count) break;  // the accessor was cut to its first elements
        piece(next, at);
        f(ElementRun{values.data + i * values.stride, values.stride, at, 1});
        next = at + 1;
    }
    piece(next, accessor.count);
}

}  // namespace alhazen::gltf
