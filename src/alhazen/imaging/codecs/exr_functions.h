#pragma once
/// The codec of OpenEXR as a module, which the program loads with the first EXR picture.
///
/// Conventions: the module `libalhazen_exr.so` exports one table under the name below. The table
/// begins with a digest of the headers whose types cross its border and the sizes of these types,
/// for a check against another build. The module has its own copy of `alhazen_base`: codecs must
/// not use its thread-local state (base/interruption.h).

#include <array>
#include <cstddef>

#include "alhazen/imaging/codecs/exr.h"
#include "alhazen/imaging/codecs/exr_layers.h"

namespace alhazen {

inline constexpr std::array<std::size_t, 6> kExrTypeSizes{
    sizeof(Image), sizeof(ImageLimits), sizeof(ImageWriteOptions),
    sizeof(Film),  sizeof(FilmLayers),  sizeof(ExrLayersOptions)};

inline constexpr std::size_t kExrDigestDigits = 16;

struct ExrFunctions {
    char headers[kExrDigestDigits + 1] = ALHAZEN_EXR_HEADERS;
    std::array<std::size_t, 6> type_sizes = kExrTypeSizes;
    decltype(&decode_exr) decode = decode_exr;
    decltype(&encode_exr) encode = encode_exr;
    decltype(&encode_exr_layers) encode_layers = encode_exr_layers;
};

inline constexpr const char* kExrFunctionsName = "alhazen_exr_functions";

}  // namespace alhazen
