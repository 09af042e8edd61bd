#include "alhazen/formats/obj/obj_materials.h"

#include <algorithm>
#include <bit>

#include "alhazen/base/file.h"
#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/mesh/mesh_scene.h"
#include "alhazen/formats/obj/bump_map.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

/// Illumination models with transmission: glass, refraction.
bool is_glass(const MtlMaterial& m) {
    return m.illum && (*m.illum == 4 || *m.illum == 6 || *m.illum == 7 || *m.illum == 9);
}

Rgb white() {
    return {1, 1, 1};
}

/// The coefficient of a textured property: white if it is black or absent, since exporters often
/// write that where only the texture is intended.
Rgb beside(const std::optional<Rgb>& value, const MtlMap& map, const Rgb& missing = {}) {
    if (!map.file.empty() && (!value || value->is_black())) return white();
    return value.value_or(missing);
}

/// The part of a name before a comment, or all of it.
std::string without_comment(const std::string& name) {
    const std::size_t comment = std::min(name.find(" #"), name.find("\t#"));
    if (comment == std::string::npos) return name;
    const std::size_t last = name.find_last_not_of(" \t", comment);
    return last == std::string::npos ? name : name.substr(0, last + 1);
}

/// The words of a line; a backslash escapes a blank within a word.
std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words(1);
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool blank = TextCursor::is_blank(line[i]);
        if (line[i] == '\\' && i + 1 < line.size() && TextCursor::is_blank(line[i + 1])) {
            words.back() += line[++i];
        } else if (!blank) {
            words.back() += line[i];
        } else if (!words.back().empty()) {
            words.emplace_back();
        }
    }
    if (words.back().empty()) words.pop_back();
    return words;
}

}  // namespace

ObjMaterials::ObjMaterials(const ImportSource& source, SceneDescription& scene,
                           Diagnostics& diagnostics, bool colored)
    : source_(source),
      scene_(scene),
      diagnostics_(diagnostics),
      colored_(colored),
      folder_(folder_of(source.path)),
      roots_(scene_roots(source.options, folder_)),
      textures_(scene, picture_findings_, roots_, source.options.image_limits),
      finder_(roots_, folder_, PictureFinder::Elsewhere::BesideTheScene) {}

void ObjMaterials::load(const std::vector<ObjLibrary>& libraries) {
    for (const ObjLibrary& library : libraries) {
        const FileLocation where{source_.path.string(), int(library.line), 0};
        // Tries the line as one name with blanks, then as several names.
        if (load_library(library.names, where)) continue;
        const std::vector<std::string> names = words_of(library.names);
        std::string missing;
        for (const std::string& name : names) {
            if (load_library(name, where)) continue;
            missing += (missing.empty() ? "'" : ", '") + name.substr(0, 200) + "'";
        }
        if (missing.empty()) continue;
        diagnostics_.warning(where, "the material file " + missing.substr(0, 1000) +
                                        " does not exist or lies outside the scene's folder");
    }
}

bool ObjMaterials::load_library(const std::string& name, const FileLocation& where) {
    const auto [known, fresh] = loaded_.try_emplace(name, false);
    if (!fresh) return known->second;
    const std::optional<std::string> found = finder_.find(name);
    if (!found) return false;
    known->second = true;
    try {
        const std::filesystem::path path = resolve_inside(roots_, folder_, *found);
        diagnostics_.note_file(path);
        const std::string bytes = read_file(path, source_.options.max_included_bytes);
        const std::string_view text = without_byte_order_mark(bytes);
        refuse_wide_text(text, path.string());
        std::vector<MtlMaterial> materials = read_mtl(text, path.string(), diagnostics_);
        for (MtlMaterial& material : materials) {
            if (!entry_of_.try_emplace(material.name, entries_.size()).second) continue;
            entry_of_part_.try_emplace(without_comment(material.name), entries_.size());
            entries_.push_back(std::move(material));
            entry_folders_.push_back(std::filesystem::path(*found).parent_path().string());
        }
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Resource) throw;
        diagnostics_.warning(where,
                             std::string("the material file cannot be read: ") + error.what());
    }
    return true;
}

void ObjMaterials::unify(ObjStatements& statements) const {
    std::vector<std::uint32_t> first_of(statements.materials.size());
    std::unordered_map<std::size_t, std::uint32_t> of_entry;
    std::unordered_map<std::string, std::uint32_t> of_name;
    for (std::uint32_t i = 0; i < first_of.size(); ++i) {
        std::string& name = statements.materials[i];
        const std::optional<std::size_t> entry = find_entry(name);
        if (!entry_of_.contains(name)) name = obj_name_of(name);
        first_of[i] = entry ? of_entry.try_emplace(*entry, i).first->second
                            : of_name.try_emplace(name, i).first->second;
    }
    for (ObjRun& run : statements.runs) run.material = first_of[run.material];
    for (ObjElement& element : statements.free_form.surfaces) {
        element.material = first_of[element.material];
    }
}

MaterialId ObjMaterials::use(const std::string& name, const FileLocation& where) {
    if (name.empty()) return grey();
    const auto [entry, fresh] = used_.try_emplace(name);
    if (!fresh) return entry->second;
    const std::optional<std::size_t> found = find_entry(name);
    if (!found) {
        diagnostics_.warning(where,
                             "no material library has '" + name.substr(0, 200) + "'; it is grey");
        entry->second = grey();
    } else {
        current_folder_ = entry_folders_[*found];
        entry->second = add(entries_[*found]);
    }
    return entry->second;
}

/// Of a name with a comment the whole, else the part before it, on either side.
std::optional<std::size_t> ObjMaterials::find_entry(const std::string& name) const {
    const std::string part = without_comment(name);
    for (const std::string& key : {name, obj_name_of(name), part}) {
        if (const auto found = entry_of_.find(key); found != entry_of_.end()) return found->second;
    }
    const auto found = entry_of_part_.find(part);
    return found == entry_of_part_.end() ? std::nullopt : std::optional(found->second);
}

MaterialId ObjMaterials::grey() {
    if (!grey_) {
        grey_ = MaterialId(scene_.materials.size());
        scene_.materials.push_back(
            {default_mesh_material(colored_), {source_.path.string(), 0, 0}});
    }
    return *grey_;
}

MaterialId ObjMaterials::add(const MtlMaterial& m) {
    Material out;
    out.name = obj_name_of(m.name);
    if (entry_of_.contains(out.name)) out.name = m.name;
    const bool says_nothing = !m.ka && !m.ks && !m.ke && !m.tf;
    const Rgb missing = says_nothing ? default_mesh_material(colored_).diffuse.color : Rgb{};
    out.diffuse = color(beside(m.kd, m.map_kd, missing), m.map_kd);
    out.ambient = out.diffuse;
    const bool has_ka = m.ka && !m.ka->is_black();
    if (has_ka) out.ambient.color = *m.ka;
    if (!m.map_ka.file.empty()) {
        const ColorInput own = color(beside(m.ka, m.map_ka), m.map_ka);
        if (has_ka || own.texture != kNoTexture) out.ambient = own;
    }
    out.emission = color(beside(m.ke, m.map_ke), m.map_ke);
    out.index.value = m.ni && *m.ni > 0 ? *m.ni : 1.0;
    set_reflection(m, out);
    set_light_through(m, out);
    out.normal_map = normal_map(m);
    if (m.pr || m.pm || m.pc.value_or(0.0) > 0.0 || !m.map_pr.file.empty() ||
        !m.map_pm.file.empty()) {
        set_metallic_roughness(m, out);
    }
    scene_.materials.push_back({std::move(out), m.location});
    return MaterialId(scene_.materials.size() - 1);
}

void ObjMaterials::set_reflection(const MtlMaterial& m, Material& out) {
    const int illum = m.illum.value_or(2);
    const bool reflects = illum == 3 || illum == 4 || illum == 5 || illum == 6 || illum == 7;
    if (illum < 2) return;
    const ColorInput ks = color(beside(m.ks, m.map_ks), m.map_ks);
    if (reflects) out.reflective = ks;
    // An exponent of 0 would cover the whole facing side; exporters write it for "no highlight".
    const double ns = m.ns.value_or(0.0);
    if (!(ns > 0.0)) return;
    out.specular = ks;
    out.shininess = scalar(ns, m.map_ns);
}

double ObjMaterials::dissolve_of(const MtlMaterial& m) {
    double d = m.d.value_or(1.0);
    if (!m.d && m.tr) {
        d = 1.0 - *m.tr;
        if (d <= 0.0 && !is_glass(m)) {
            diagnostics_.warning(m.location, "'Tr' alone makes the material '" +
                                                 m.name.substr(0, 200) +
                                                 "' invisible; it is taken as opaque");
            d = 1.0;
        }
    }
    return std::clamp(d, 0.0, 1.0);
}

void ObjMaterials::set_light_through(const MtlMaterial& m, Material& out) {
    const double d = dissolve_of(m);
    if (is_glass(m)) {
        const double passes = d < 1.0 ? 1.0 - d : m.tf || !(m.d || m.tr) ? 1.0 : 0.0;
        out.transmissive.color = passes * m.tf.value_or(white());
        return;
    }
    const TextureId map = texture(m.map_d, false);
    if (d >= 1.0 && map == kNoTexture) return;
    out.alpha_mode = AlphaMode::Blend;
    out.alpha = {d * m.map_d.gain, map, Channel::Mean};
    if (map == kNoTexture) return;
    // Coverage from the alpha channel, otherwise from the grey value.
    const bool used = !image_texture(map).image->is_opaque();
    out.alpha.channel = m.map_d.channel.value_or(used ? Channel::Alpha : Channel::Mean);
}

void ObjMaterials::set_metallic_roughness(const MtlMaterial& m, Material& out) {
    MetallicRoughness mr;
    mr.base_color = out.diffuse;
    mr.metallic = scalar(m.pm.value_or(m.map_pm.file.empty() ? 0.0 : 1.0), m.map_pm);
    mr.roughness = scalar(m.pr.value_or(1.0), m.map_pr);
    mr.coat.strength.value = std::clamp(m.pc.value_or(0.0), 0.0, 1.0);
    mr.coat.roughness.value = std::clamp(m.pcr.value_or(0.0), 0.0, 1.0);
    mr.transmission.value = out.transmissive.color.max();
    mr.thickness.value = mr.transmission.value > 0.0 ? 1.0 : 0.0;
    if (!m.ni || !(*m.ni >= 1.0)) out.index.value = 1.5;
    out.metallic_roughness = mr;
}

NormalMap ObjMaterials::normal_map(const MtlMaterial& m) {
    if (const TextureId id = texture(m.normal, false); id != kNoTexture) {
        return {id, m.normal.bump};
    }
    const MtlMap& map = m.map_bump;
    if (map.bump == 0.0) return {};
    const TextureId id = texture(map, false);
    if (id == kNoTexture) return {};
    // An explicit channel indicates scalar data.
    if (!map.channel && is_normal_map(image_texture(id).image)) {
        return {id, map.bump};
    }
    const HeightMap heights{map.bump * map.gain, map.channel.value_or(Channel::Mean),
                            map.clamp ? Wrap::Clamp : Wrap::Repeat};
    const std::string key = std::to_string(std::bit_cast<std::uint64_t>(heights.strength)) + ' ' +
                            std::to_string(int(heights.channel)) + (map.clamp ? " clamp" : "");
    textures_.derive(id, key, [&](const StoredImage& picture) {
        return normals_from_heights(picture, heights);
    });
    return {id, 1.0};
}

bool ObjMaterials::is_normal_map(const std::shared_ptr<const StoredImage>& picture) {
    const auto [known, fresh] = is_normal_map_.try_emplace(picture, false);
    if (fresh) known->second = looks_like_normal_map(*picture);
    return known->second;
}

std::optional<std::string> ObjMaterials::find_picture(const std::string& written) {
    const auto find = [&](const std::string& name) {
        std::optional<std::string> found;
        if (!current_folder_.empty()) found = finder_.find(current_folder_ + "/" + name);
        return found ? found : finder_.find(name);
    };
    if (auto found = find(written)) return found;
    const std::string part = without_comment(written);
    return part == written ? std::nullopt : find(part);
}

TextureId ObjMaterials::texture(const MtlMap& map, bool is_color) {
    if (map.file.empty()) return kNoTexture;
    const std::optional<std::string> found = find_picture(map.file);
    if (!found) {
        diagnostics_.warning(map.location, "the picture '" + map.file.substr(0, 200) +
                                               "' does not exist or lies outside the scene's "
                                               "folder; it is omitted");
        return kNoTexture;
    }
    ImageTexture settings;
    settings.filter = TextureFilter::Mipmapped;
    settings.wrap_u = settings.wrap_v = map.clamp ? Wrap::Clamp : Wrap::Repeat;
    settings.uv_transform = {map.scale.x, 0, 0, map.scale.y, map.offset};
    const std::size_t errors = picture_findings_.error_count();
    diagnostics_.note_file(folder_ / *found);
    const auto id = textures_.load(*found, folder_, settings, map.file, map.location);
    if (picture_findings_.error_count() != errors && !picture_findings_.all().empty()) {
        diagnostics_.warning(map.location,
                             picture_findings_.all().back().message + "; it is omitted");
    }
    if (!id) return kNoTexture;
    ImageTexture& texture = image_texture(*id);
    texture.decode_srgb = is_color && !texture.image->linear;
    return *id;
}

ColorInput ObjMaterials::color(const Rgb& value, const MtlMap& map) {
    const TextureId id = texture(map, true);
    return {id == kNoTexture ? value : map.gain * value, id};
}

ScalarInput ObjMaterials::scalar(double value, const MtlMap& map) {
    const TextureId id = texture(map, false);
    return {id == kNoTexture ? value : map.gain * value, id, map.channel.value_or(Channel::Mean)};
}

}  // namespace alhazen
