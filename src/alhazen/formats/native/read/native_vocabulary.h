#pragma once
/// The blocks of the native format and their keys, as the reader accepts them, for programs that
/// make scenes and for documentation.
///
/// Derivation: the reader reads an empty block of each type, and one with each word of each
/// keyword, while its queries are recorded. Units and defaults of shapes are those of their
/// kFields.

#include <string>
#include <vector>

namespace alhazen {

struct NativeKey {
    std::string name;
    std::vector<std::string> words = {};  ///< for a keyword: its possible values
    bool required = false;
    std::string unit = {};   ///< of a shape's field: "point", "length", ...; else empty
    std::string usual = {};  ///< default of a shape's field, as text; else empty
};

struct NativeBlockType {
    std::string name;
    bool is_shape = false;
    std::vector<NativeKey> keys;
};

/// The block types in the order of `native_block_names`, without `include`, which is not a block.
[[nodiscard]] std::vector<NativeBlockType> native_vocabulary();

}  // namespace alhazen
