// The functions of exr.h and exr_layers.h in the program, which loads the module with the first
// EXR picture: OpenEXR's four libraries would take a fifth of the time of every start.

#include <dlfcn.h>

#include <filesystem>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/exr_functions.h"

namespace alhazen {

namespace {

/// Opens the module beside the program, as it is built; where it is installed; or on the loader's
/// search path.
void* open_module() {
    constexpr const char* kFile = "libalhazen_exr.so";
    std::error_code unknown;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
    for (const auto& path : {folder / kFile, folder / ALHAZEN_EXR_FOLDER / kFile}) {
        void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (module != nullptr) return module;
    }
    return dlopen(kFile, RTLD_NOW | RTLD_LOCAL);
}

[[noreturn]] void fail(const std::string& why) {
    throw Error(ErrorKind::Resource, "an EXR picture needs the module libalhazen_exr.so: " + why);
}

/// Throws Error (Resource) if the module cannot be loaded.
const ExrFunctions& exr() {
    static const ExrFunctions& functions = [&]() -> const ExrFunctions& {
        void* const module = open_module();
        void* const table = module == nullptr ? nullptr : dlsym(module, kExrFunctionsName);
        if (table == nullptr) {
            const char* const why = dlerror();
            fail(why != nullptr ? why : "it has no table");
        }
        const auto& found = *static_cast<const ExrFunctions*>(table);
        if (found.type_sizes != kExrTypeSizes) fail("it belongs to another build");
        return found;
    }();
    return functions;
}

}  // namespace

Image decode_exr(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    return exr().decode(bytes, name, limits);
}

std::vector<std::byte> encode_exr(const Image& image, const ImageWriteOptions& options) {
    return exr().encode(image, options);
}

std::vector<std::byte> encode_exr_layers(const Film& film, const FilmLayers& layers,
                                         const ExrLayersOptions& options) {
    return exr().encode_layers(film, layers, options);
}

}  // namespace alhazen
