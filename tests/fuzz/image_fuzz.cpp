/// Any bytes as a picture of one format: an Error or a picture whose samples fit its sizes, nothing
/// else.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/bmp.h"
#include "alhazen/imaging/codecs/exr.h"
#include "alhazen/imaging/codecs/hdr.h"
#include "alhazen/imaging/codecs/jpeg.h"
#include "alhazen/imaging/codecs/pfm.h"
#include "alhazen/imaging/codecs/png.h"
#include "alhazen/imaging/codecs/stored_image.h"
#include "alhazen/imaging/codecs/tga.h"

namespace {

/// Some decoders give codes, some samples.
[[maybe_unused]] alhazen::Image picture(alhazen::StoredImage stored) {
    return alhazen::expanded(std::move(stored));
}
[[maybe_unused]] alhazen::Image picture(alhazen::Image image) {
    return image;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    try {
        const alhazen::Image image = picture(alhazen::ALHAZEN_FUZZ_DECODER(
            bytes, "fuzz", {.max_side = 2048, .max_pixels = 1 << 18}));
        const std::size_t expected =
            std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels);
        if (expected == 0 || image.samples.size() != expected) std::abort();
    } catch (const alhazen::Error& error) {
        if (error.kind() != alhazen::ErrorKind::Scene &&
            error.kind() != alhazen::ErrorKind::Resource) {
            std::abort();
        }
    }
    return 0;
}
