#pragma once
/// The layers of an image as separate PNG files for viewing, and the names of their ids
/// (docs/reference/layers.md).

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/figures/false_color.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// A picture of a layer, with the meaning of its colours.
struct LayerPicture {
    EncodedImage image;
    std::string meaning;
    ImageMetadata scale;               ///< scale of the values, stored as text in a PNG
    std::optional<ColorScale> colors;  ///< for layers of one number per pixel
};

/// The picture of a layer. `layers` must have the channels of `entry`; `draws_scale`: draws the
/// colour scale, if there is one, below the picture.
[[nodiscard]] LayerPicture layer_picture(const AovEntry& entry, const FilmLayers& layers,
                                         bool draws_scale);

/// OUT.NAME.png for each layer, beside OUT.anything, in the order of the table.
[[nodiscard]] std::vector<std::filesystem::path> aov_picture_paths(
    const std::filesystem::path& output, const AovSet& wanted);

/// Writes the pictures, each with its scale in the text of the PNG, and returns one line per
/// picture. Throws Error (File).
std::vector<std::string> write_aov_pictures(const std::filesystem::path& output,
                                            const AovSet& wanted, const FilmLayers& layers,
                                            const ImageMetadata& metadata);

/// The name of a part by its number. For an unnamed part, its kind of shape or the name of its mesh
/// or object.
[[nodiscard]] std::string part_name(const SceneDescription& description, std::uint32_t number);
/// A JSON object from id to name for each wanted kind of id, under "alhazen.id.object" and so on;
/// each is truncated at 64 KiB.
[[nodiscard]] ImageMetadata id_names(const SceneDescription& description, const AovSet& wanted);

}  // namespace alhazen
