#pragma once
/// The blocks of the native format and their keys, as the reader knows them: for programs that make
/// scenes, and for their documentation.
///
/// Derivation: the reader reads an empty block of each type, and one with each word of each
/// keyword, while what it asks for is noted. Units and defaults of shapes are those of their
/// kFields.

#include <string>
#include <vector>

namespace alhazen {

struct NativeKey {
    std::string name;
    std::vector<std::string> words = {};  ///< keywords: the value is one of these
    bool required = false;
    std::string unit = {};   ///< of a shape's field: "point", "length", ...; else empty
    std::string usual = {};  ///< default of a shape's field as text; else empty
};

struct NativeBlockType {
    std::string name;
    bool is_shape = false;
    std::vector<NativeKey> keys;
};

/// In the order of `native_block_names`; without `include`, which is no block.
[[nodiscard]] std::vector<NativeBlockType> native_vocabulary();

}  // namespace alhazen
