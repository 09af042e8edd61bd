#include "alhazen/formats/ply/ply_vertices.h"

#include <algorithm>
#include <utility>

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

namespace {

/// Clamps `v`; NaN becomes `lowest`.
double within(double v, double lowest, double highest) {
    return v > lowest ? std::min(v, highest) : lowest;
}

}  // namespace

float linear_of_code(std::uint8_t code) {
    static const std::array<float, 256> kTable = [] {
        std::array<float, 256> table{};
        for (std::size_t i = 0; i < table.size(); ++i) {
            table[i] = float(linear_from_srgb(double(i) / 255.0));
        }
        return table;
    }();
    return kTable[code];
}

PlyVertexLayout::PlyVertexLayout(const PlyElement& element, bool exact) {
    for (const PlyProperty& property : element.properties) {
        const std::size_t slot = slot_of(property, exact);
        slots_.push_back(slot);
        present_[slot] = true;
        types_[slot] = property.type;
    }
    normals_ = has(kNormal, 3);
    uvs_ = has(kUv, 2);
    uvs2_ = has(kUv2, 2);
    colors_ = has(kColor, 3);
    tangents_ = has(kTangent, 4);
    materials_ = has(kMaterial, 1);
    find_oddities(element);
}

void PlyVertexLayout::find_oddities(const PlyElement& element) {
    std::array<std::size_t, kUnused> last{};
    for (std::size_t k = 0; k < slots_.size(); ++k) {
        const std::size_t slot = slots_[k];
        if (slot == kUnused) continue;
        const std::size_t before = std::exchange(last[slot], k + 1);
        if (before == 0) continue;
        oddities_.push_back("'" + element.properties[before - 1].name +
                            "' of a vertex is ignored, because '" + element.properties[k].name +
                            "' follows");
    }
    struct Group {
        std::size_t first, count;
        const char* names;
    };
    static constexpr std::array<Group, 5> kGroups{{{kNormal, 3, "nx, ny and nz"},
                                                   {kUv, 2, "u and v"},
                                                   {kUv2, 2, "u2 and v2"},
                                                   {kColor, 3, "red, green and blue"},
                                                   {kTangent, 4, "tx, ty, tz and tsign"}}};
    for (const Group& group : kGroups) {
        if (has(group.first, group.count)) continue;
        for (std::size_t slot = group.first; slot < group.first + group.count; ++slot) {
            if (last[slot] == 0) continue;
            oddities_.push_back("'" + element.properties[last[slot] - 1].name +
                                "' of a vertex is ignored: only all of " + group.names +
                                " have a meaning");
            break;
        }
    }
}

std::size_t PlyVertexLayout::slot_of(const PlyProperty& property, bool exact) {
    static constexpr std::array<std::pair<std::string_view, std::size_t>, 31> kSlots{
        {{"x", kX},
         {"y", kX + 1},
         {"z", kX + 2},
         {"nx", kNormal},
         {"ny", kNormal + 1},
         {"nz", kNormal + 2},
         {"u", kUv},
         {"v", kUv + 1},
         {"s", kUv},
         {"t", kUv + 1},
         {"texture_u", kUv},
         {"texture_v", kUv + 1},
         {"u2", kUv2},
         {"v2", kUv2 + 1},
         {"red", kColor},
         {"green", kColor + 1},
         {"blue", kColor + 2},
         {"diffuse_red", kColor},
         {"diffuse_green", kColor + 1},
         {"diffuse_blue", kColor + 2},
         {"r", kColor},
         {"g", kColor + 1},
         {"b", kColor + 2},
         {"alpha", kAlpha},
         {"diffuse_alpha", kAlpha},
         {"a", kAlpha},
         {"tx", kTangent},
         {"ty", kTangent + 1},
         {"tz", kTangent + 2},
         {"tsign", kTangent + 3},
         {"vertex_material", kMaterial}}};
    if (property.count_type) return kUnused;
    for (const auto& [name, slot] : kSlots) {
        // A material index is meaningful only in the scene for which the file was written.
        if (property.name == name) return slot == kMaterial && !exact ? kUnused : slot;
    }
    return kUnused;
}

bool PlyVertexLayout::has(std::size_t first, std::size_t count) const {
    return std::all_of(present_.begin() + std::ptrdiff_t(first),
                       present_.begin() + std::ptrdiff_t(first + count), [](bool b) { return b; });
}

void PlyVertexLayout::reserve(TriangleMesh& mesh, std::uint64_t count) const {
    mesh.positions.reserve(count);
    if (normals_) mesh.normals.reserve(count);
    if (uvs_) mesh.uvs.reserve(count);
    if (uvs2_) mesh.uvs2.reserve(count);
    if (colors_) mesh.colors.reserve(count);
    if (tangents_) mesh.tangents.reserve(count);
    if (materials_) mesh.vertex_materials.reserve(count);
}

float PlyVertexLayout::color(std::size_t slot) const {
    const double v = values_[slot];
    switch (types_[slot]) {
        case PlyType::Float32:
        case PlyType::Float64:
            return float(v);
        case PlyType::Uint8:
            // An ascii value may exceed the range of its type.
            return slot == kAlpha ? float(within(v, 0.0, 255.0) / 255.0)
                                  : linear_of_code(std::uint8_t(within(v, 0.0, 255.0)));
        default:
            const double most = types_[slot] == PlyType::Uint16 ? 65535.0 : 255.0;
            const double unit = within(v / most, 0.0, 1.0);
            return float(slot == kAlpha ? unit : linear_from_srgb(unit));
    }
}

void PlyVertexLayout::append(TriangleMesh& mesh) const {
    const auto& v = values_;
    mesh.positions.push_back({v[kX], v[kX + 1], v[kX + 2]});
    if (normals_) mesh.normals.push_back({v[kNormal], v[kNormal + 1], v[kNormal + 2]});
    if (uvs_) mesh.uvs.push_back({v[kUv], v[kUv + 1]});
    if (uvs2_) mesh.uvs2.push_back({v[kUv2], v[kUv2 + 1]});
    if (colors_) {
        mesh.colors.push_back({color(kColor), color(kColor + 1), color(kColor + 2),
                               present_[kAlpha] ? color(kAlpha) : 1.0f});
    }
    if (tangents_) {
        mesh.tangents.push_back({float(v[kTangent]), float(v[kTangent + 1]), float(v[kTangent + 2]),
                                 float(v[kTangent + 3])});
    }
    if (materials_) {
        mesh.vertex_materials.push_back(
            std::uint32_t(within(v[kMaterial], 0.0, double(0xFFFFFFFFu))));
    }
}

}  // namespace alhazen
