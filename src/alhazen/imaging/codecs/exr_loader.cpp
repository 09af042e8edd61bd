// The functions of exr.h and exr_layers.h in the program, which loads the module with the first
// EXR picture: OpenEXR's four libraries would take a fifth of the time of every start.

#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/exr_functions.h"

namespace alhazen {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& why) {
    throw Error(ErrorKind::Resource, "an EXR picture needs the module libalhazen_exr.so: " + why);
}

/// The folder of the program; empty if unknown.
fs::path program_folder() {
    // An object of the program itself, in case that the loader was started with it as argument.
    Dl_info self{};
    static const char here = 0;
    std::error_code unknown;
    if (dladdr(&here, &self) != 0 && self.dli_fname != nullptr) {
        const fs::path file = fs::canonical(self.dli_fname, unknown);
        if (!unknown) return file.parent_path();
    }
    const fs::path file = fs::read_symlink("/proc/self/exe", unknown);
    return unknown ? fs::path() : file.parent_path();
}

/// Opens the module beside the program, as it is built; where it is installed; or on the loader's
/// search path.
void* open_module() {
    constexpr const char* kFile = "libalhazen_exr.so";
    if (const fs::path folder = program_folder(); !folder.empty()) {
        for (const auto& path : {folder / kFile, folder / ALHAZEN_EXR_FOLDER / kFile}) {
            std::error_code unknown;
            if (!fs::exists(path, unknown)) continue;
            void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
            if (module != nullptr) return module;
            const char* const why = dlerror();
            fail(why != nullptr ? why : path.string());
        }
    }
    void* const module = dlopen(kFile, RTLD_NOW | RTLD_LOCAL);
    if (module != nullptr) return module;
    const char* const why = dlerror();
    fail(why != nullptr ? why : "it is not found");
}

/// Throws Error (Resource) if the module cannot be loaded.
const ExrFunctions& exr() {
    static const ExrFunctions& functions = [&]() -> const ExrFunctions& {
        void* const table = dlsym(open_module(), kExrFunctionsName);
        if (table == nullptr) {
            const char* const why = dlerror();
            fail(why != nullptr ? why : "it has no table");
        }
        const auto& found = *static_cast<const ExrFunctions*>(table);
        constexpr std::string_view kHeaders = ALHAZEN_EXR_HEADERS;
        if (std::string_view(found.headers, kHeaders.size()) != kHeaders ||
            found.type_sizes != kExrTypeSizes) {
            fail("it belongs to another build");
        }
        return found;
    }();
    return functions;
}

}  // namespace

void require_exr() {
    static_cast<void>(exr());
}

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
