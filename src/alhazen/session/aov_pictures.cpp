#include "alhazen/session/aov_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

constexpr std::size_t kMaxNameBytes = 64 * 1024;
/// Keeps a few pixels that other processes interrupted from darkening the picture of times.
constexpr double kTimeQuantile = 0.99;

using Channels = std::vector<const LayerChannel*>;

/// The values of a channel of any type.
std::vector<float> numbers_of(const LayerChannel& channel) {
    if (channel.type != SampleType::Uint) return channel.values;
    return {channel.whole.begin(), channel.whole.end()};
}

std::vector<float> finite_values(const LayerChannel& channel) {
    std::vector<float> values = numbers_of(channel);
    std::erase_if(values, [](float v) { return !std::isfinite(v); });
    return values;
}

/// A picture whose 8-bit codes are three functions of a pixel's values.
template <class F>
LayerPicture direct_picture(const PixelBox& crop, std::string meaning, F&& display) {
    LayerPicture picture;
    picture.meaning = std::move(meaning);
    picture.image.width = crop.width();
    picture.image.height = crop.height();
    picture.image.samples.reserve(3 * crop.area());
    for (std::size_t i = 0; i < crop.area(); ++i) {
        for (const double v : display(i)) {
            const double clamped = v > 0.0 ? std::min(v, 1.0) : 0.0;  // NaN becomes 0
            picture.image.samples.push_back(
                static_cast<std::uint16_t>(std::lround(255.0 * clamped)));
        }
    }
    return picture;
}

LayerPicture scaled_picture(const PixelBox& crop, const LayerChannel& channel, ColorScale scale) {
    scale.title = channel.name;
    std::transform(scale.title.begin(), scale.title.end(), scale.title.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    LayerPicture picture;
    picture.image = false_color(numbers_of(channel), crop.width(), crop.height(), scale);
    picture.colors = scale;
    picture.meaning = fmt::format("{:.6g} to {:.6g}", scale.low, scale.high);
    picture.scale = {{"alhazen.aov.low", fmt::format("{:.9g}", scale.low)},
                     {"alhazen.aov.high", fmt::format("{:.9g}", scale.high)}};
    return picture;
}

/// The value below which `share` of `values` lie. Reorders `values`, which must not be empty.
float quantile_of(std::vector<float>& values, double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

LayerPicture depth_picture(const PixelBox& crop, const LayerChannel& channel, bool drawn) {
    // On unbounded ground a few pixels see a thousand times farther than all others.
    constexpr double kMost = 0.9;
    constexpr double kFarBeyond = 4.0;  // both counted from the nearest point
    std::vector<float> values = finite_values(channel);
    ColorScale scale{
        .low = 0, .high = 0, .colors = ColorScale::Colors::NearGrey, .title = "", .drawn = drawn};
    bool has_beyond = false;
    if (!values.empty()) {
        const auto [near, far] = std::minmax_element(values.begin(), values.end());
        scale.low = *near;
        scale.high = *far;
        const double most = quantile_of(values, kMost);
        has_beyond = scale.high - scale.low > kFarBeyond * (most - scale.low) && most > scale.low;
        if (has_beyond) scale.high = most;
    }
    LayerPicture picture = scaled_picture(crop, channel, scale);
    if (has_beyond) picture.meaning += ", a tenth of the pixels beyond";
    return picture;
}

LayerPicture heat_picture(const PixelBox& crop, const LayerChannel& channel, double quantile,
                          bool drawn) {
    std::vector<float> values = finite_values(channel);
    ColorScale scale{
        .low = 0, .high = 0, .colors = ColorScale::Colors::Heat, .title = "", .drawn = drawn};
    if (!values.empty()) scale.high = quantile_of(values, quantile);
    return scaled_picture(crop, channel, scale);
}

LayerPicture id_picture(const PixelBox& crop, const LayerChannel& channel) {
    return direct_picture(crop, "a colour for each", [&](std::size_t i) {
        const auto codes = id_color(channel.whole[i]);
        return std::array<double, 3>{codes[0] / 255.0, codes[1] / 255.0, codes[2] / 255.0};
    });
}

LayerPicture normal_picture(const PixelBox& crop, const Channels& c) {
    return direct_picture(crop, "(n + 1) / 2, black where nothing is", [&](std::size_t i) {
        std::array<double, 3> n{c[0]->values[i], c[1]->values[i], c[2]->values[i]};
        const bool none = n == std::array<double, 3>{};
        for (double& x : n) x = none ? 0.0 : 0.5 * (x + 1.0);
        return n;
    });
}

/// True if all three values of a pixel are 0: the pixel is empty.
bool is_empty(const Channels& c, std::size_t i) {
    return std::all_of(c.begin(), c.end(), [&](const auto* k) { return k->values[i] == 0.0f; });
}

LayerPicture position_picture(const PixelBox& crop, const Channels& c) {
    Box3 box;
    for (std::size_t i = 0; i < crop.area(); ++i) {
        if (!is_empty(c, i)) box.include(Vec3{c[0]->values[i], c[1]->values[i], c[2]->values[i]});
    }
    if (box.empty()) box.include(Vec3{});
    const Vec3 lo = box.lo, range = box.size();
    auto picture =
        direct_picture(crop,
                       fmt::format("x {:.6g} to {:.6g}, y {:.6g} to {:.6g}, z {:.6g} to {:.6g}",
                                   lo.x, box.hi.x, lo.y, box.hi.y, lo.z, box.hi.z),
                       [&](std::size_t i) {
                           std::array<double, 3> p{};
                           if (is_empty(c, i)) return p;
                           for (int k = 0; k < 3; ++k) {
                               const auto at = static_cast<std::size_t>(k);
                               if (range[k] > 0.0)
                                   p[at] = (double{c[at]->values[i]} - lo[k]) / range[k];
                           }
                           return p;
                       });
    picture.scale = {{"alhazen.aov.range", picture.meaning}};
    return picture;
}

/// Shows the fractional part of texture coordinates, as textures repeat; 1 stays 1.
LayerPicture uv_picture(const PixelBox& crop, const Channels& c) {
    const auto wrapped = [](double x) { return x >= 0.0 && x <= 1.0 ? x : x - std::floor(x); };
    return direct_picture(crop, "u red, v green, repeating", [&](std::size_t i) {
        return std::array<double, 3>{wrapped(c[0]->values[i]), wrapped(c[1]->values[i]), 0.0};
    });
}

LayerPicture albedo_picture(const PixelBox& crop, const Channels& c) {
    return direct_picture(crop, "sRGB", [&](std::size_t i) {
        std::array<double, 3> rgb{};
        for (std::size_t k = 0; k < 3; ++k) {
            rgb[k] = srgb_from_linear(std::clamp(double{c[k]->values[i]}, 0.0, 1.0));
        }
        return rgb;
    });
}

/// Shows angles modulo pi as hues.
LayerPicture angle_picture(const PixelBox& crop, const Channels& c) {
    return direct_picture(crop, "hue, red at 0, green and blue a third of pi apart",
                          [&](std::size_t i) {
                              std::array<double, 3> rgb{};
                              for (std::size_t k = 0; k < 3; ++k) {
                                  const double third = kPi * static_cast<double>(k) / 3.0;
                                  rgb[k] = 0.5 + 0.5 * std::cos(2.0 * (c[0]->values[i] - third));
                              }
                              return rgb;
                          });
}

/// Shows Stokes parameters; 0 is grey.
LayerPicture stokes_picture(const PixelBox& crop, const Channels& c) {
    return direct_picture(crop, "(1 + s) / 2", [&](std::size_t i) {
        std::array<double, 3> rgb{};
        for (std::size_t k = 0; k < 3; ++k) rgb[k] = 0.5 + 0.5 * double{c[k]->values[i]};
        return rgb;
    });
}

LayerPicture picture_of(AovKind kind, const PixelBox& crop, const Channels& c, bool drawn) {
    switch (kind) {
        case AovKind::PolarizationAngle:
            return angle_picture(crop, c);
        case AovKind::Stokes:
            return stokes_picture(crop, c);
        case AovKind::PolarizationDegree:
        case AovKind::Alpha:
            return direct_picture(crop, "0 to 1", [&](std::size_t i) {
                const double a = c[0]->values[i];
                return std::array<double, 3>{a, a, a};
            });
        case AovKind::Depth:
            return depth_picture(crop, *c[0], drawn);
        case AovKind::Normal:
        case AovKind::GeometricNormal:
            return normal_picture(crop, c);
        case AovKind::Position:
            return position_picture(crop, c);
        case AovKind::Uv:
            return uv_picture(crop, c);
        case AovKind::Albedo:
            return albedo_picture(crop, c);
        case AovKind::ObjectId:
        case AovKind::MaterialId:
        case AovKind::InstanceId:
            return id_picture(crop, *c[0]);
        case AovKind::Emission:
        case AovKind::Direct:
        case AovKind::Indirect:
        case AovKind::Diffuse:
        case AovKind::Specular:
        case AovKind::Transmission:
            return albedo_picture(crop, c);
        case AovKind::Time:
        case AovKind::Photons:
            return heat_picture(crop, *c[0], kTimeQuantile, drawn);
        case AovKind::ErrorBound:
        case AovKind::Rays:
        case AovKind::NodeVisits:
        case AovKind::BoxTests:
        case AovKind::PrimitiveTests:
        case AovKind::Unmet:
        case AovKind::RefractionError:
        case AovKind::LightVariance:
            break;
    }
    return heat_picture(crop, *c[0], 1.0, drawn);
}

std::filesystem::path picture_path(const std::filesystem::path& output, const AovEntry& entry) {
    std::filesystem::path path = output;
    path.replace_extension();
    path += std::string(".") + entry.name + ".png";
    return path;
}

/// Collects `"id":"name"` pairs while they fit.
class NameList {
  public:
    void add(std::size_t id, const std::string& name) {
        if (name.empty() || full_) return;
        const std::string entry = fmt::format(
            "{}\"{}\":{}", text_.size() > 1 ? "," : "", id,
            nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
        full_ = text_.size() + entry.size() + 1 > kMaxNameBytes;
        if (!full_) text_ += entry;
    }
    [[nodiscard]] std::string take() { return text_ + "}"; }

  private:
    std::string text_ = "{";
    bool full_ = false;
};

std::string part_name(const SceneDescription& d, const Part& part) {
    if (!part.name.empty()) return part.name;
    if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
        return std::visit([](const auto& s) { return std::string(s.kName); }, *shape);
    }
    if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
        return d.meshes[static_cast<std::size_t>(*mesh)].name;
    }
    return d.objects[static_cast<std::size_t>(std::get<ObjectIndex>(part.what))].name;
}

}  // namespace

LayerPicture layer_picture(const AovEntry& entry, const FilmLayers& layers, bool draws_scale) {
    Channels channels;
    for (const char* name : entry.channels) channels.push_back(layers.find(name));
    return picture_of(entry.kind, layers.crop(), channels, draws_scale);
}

std::vector<std::filesystem::path> aov_picture_paths(const std::filesystem::path& output,
                                                     const AovSet& wanted) {
    std::vector<std::filesystem::path> paths;
    for (const AovEntry& entry : aov_table()) {
        if (wanted.has(entry.kind)) paths.push_back(picture_path(output, entry));
    }
    return paths;
}

std::vector<std::string> write_aov_pictures(const std::filesystem::path& output,
                                            const AovSet& wanted, const FilmLayers& layers,
                                            const ImageMetadata& metadata) {
    std::vector<std::string> lines;
    for (const AovEntry& entry : aov_table()) {
        if (!wanted.has(entry.kind)) continue;
        const LayerPicture picture = layer_picture(entry, layers, true);
        ImageMetadata text = metadata;
        text.emplace_back("alhazen.aov", entry.name);
        text.insert(text.end(), picture.scale.begin(), picture.scale.end());
        const std::filesystem::path path = picture_path(output, entry);
        write_png(path, picture.image, text);
        lines.push_back(fmt::format("{}: {}, {}", path.string(), entry.name, picture.meaning));
    }
    return lines;
}

std::string part_name(const SceneDescription& description, std::uint32_t number) {
    for (const ObjectDescription& object : description.objects) {
        if (number < object.parts.size()) return part_name(description, object.parts[number]);
        number -= static_cast<std::uint32_t>(object.parts.size());
    }
    return "";
}

ImageMetadata id_names(const SceneDescription& description, const AovSet& wanted) {
    ImageMetadata result;
    NameList parts, materials;
    std::size_t id = 0;
    for (const ObjectDescription& object : description.objects) {
        for (const Part& part : object.parts) parts.add(++id, part_name(description, part));
    }
    id = 0;
    for (const MaterialDescription& material : description.materials) {
        materials.add(++id, material.material.name);
    }
    const std::string part_names = parts.take();
    if (wanted.has(AovKind::ObjectId)) result.emplace_back("alhazen.id.object", part_names);
    if (wanted.has(AovKind::MaterialId))
        result.emplace_back("alhazen.id.material", materials.take());
    if (wanted.has(AovKind::InstanceId)) result.emplace_back("alhazen.id.instance", part_names);
    return result;
}

}  // namespace alhazen
