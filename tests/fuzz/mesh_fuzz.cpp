/// Any bytes as a mesh of one format: findings or an Error, nothing else.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "alhazen/importers/obj_reader.h"
#include "alhazen/importers/ply_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    alhazen::ImportOptions options;
    options.max_elements = 10'000;
    try {
        alhazen::Diagnostics diagnostics;
        const alhazen::TriangleMesh mesh = alhazen::ALHAZEN_FUZZ_READER(
            {reinterpret_cast<const char*>(data), size}, "fuzz", options, diagnostics);
        mesh.validate({}, diagnostics);
    } catch (const alhazen::Error&) {
    }
    return 0;
}
