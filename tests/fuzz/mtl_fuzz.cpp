/// Any bytes as a library of OBJ materials: findings, nothing else.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "alhazen/formats/obj/mtl_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    alhazen::Diagnostics diagnostics;
    (void)alhazen::read_mtl({reinterpret_cast<const char*>(data), size}, "fuzz", diagnostics);
    return 0;
}
