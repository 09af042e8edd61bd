/// Any bytes as a scene of one format: findings or an Error, nothing else. What is imported goes
/// through validation, also when it is incomplete, as in `import_scene`.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "alhazen/formats/importer_list.h"

namespace {

const alhazen::Importer& importer_under_test() {
    for (const alhazen::Importer* importer : alhazen::importers()) {
        if (importer->name() == std::string_view(ALHAZEN_FUZZ_IMPORTER)) return *importer;
    }
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const alhazen::Importer& importer = importer_under_test();
    alhazen::ImportOptions options;
    options.max_nesting = 64;
    options.max_include_depth = 4;
    options.max_included_bytes = 1 << 20;
    options.max_elements = 10'000;
    options.image_limits = {.max_side = 2048, .max_pixels = 1 << 18};
    options.time = 0.5;  // animations, skins and morph targets too
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    // A folder that does not exist, so that files named by the input are looked for, and not found.
    const alhazen::ImportSource source{bytes, "/nonexistent/fuzz", options};
    try {
        alhazen::Diagnostics diagnostics;
        (void)importer.recognise(source);
        const alhazen::SceneDescription description = importer.import(source, diagnostics);
        alhazen::validate(description, diagnostics);
    } catch (const alhazen::Error&) {
    }
    return 0;
}
