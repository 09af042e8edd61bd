#include "alhazen/formats/native/read/native_height_picture.h"

#include "alhazen/base/file.h"
#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen {

namespace {

void fill(const StoredImage& image, double low, double high, HeightField& field) {
    const auto width = static_cast<std::size_t>(image.width);
    const auto height = static_cast<std::size_t>(image.height);
    auto heights = std::make_shared<std::vector<float>>();
    heights->reserve(width * height);
    const std::size_t channels = static_cast<std::size_t>(image.channels);
    const std::size_t colors = channels >= 3 ? 3 : 1;
    std::vector<double> row(width * channels);
    for (std::size_t j = 0; j < height; ++j) {
        image.read_pixels((height - 1 - j) * width, width, false, row.data());
        for (std::size_t i = 0; i < width; ++i) {
            double sum = 0.0;
            for (std::size_t c = 0; c < colors; ++c) sum += row[i * channels + c];
            const double part = sum / static_cast<double>(colors);
            heights->push_back(static_cast<float>(low + (high - low) * part));
        }
    }
    field.columns = static_cast<std::uint32_t>(width);
    field.rows = static_cast<std::uint32_t>(height);
    field.heights = std::move(heights);
}

}  // namespace

void read_native_height_picture(BlockReader& reader, const NativeContext& context,
                                const NativeScope& scope, AnyShape& shape) {
    auto* field = std::get_if<HeightField>(&shape);
    if (field == nullptr) return;
    std::string file;
    double low = 0.0, high = 1.0;
    const bool named = reader.read("file", file);
    for (const char* key : {"low", "high"}) reader.needs(key, "file");
    if (!reader.has("file")) return;
    reader.read("low", low);
    reader.read("high", high);
    if (!named) return;
    try {
        const auto path = resolve_inside(context.roots, scope.folder, file);
        context.diagnostics.note_file(path);
        const StoredImage picture = read_stored_image(path, context.options.image_limits);
        if (picture.held.are_none()) {
            context.diagnostics.warning(reader.find("file")->location(), kNoPixelsHeld);
        }
        fill(picture, low, high, *field);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Resource) throw;
        reader.error(*reader.find("file"), error.what());
    }
}

}  // namespace alhazen
