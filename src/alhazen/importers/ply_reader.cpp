#include "alhazen/importers/ply_reader.h"

#include <bit>
#include <cstring>

#include "alhazen/importers/mesh_io_normals.h"
#include "alhazen/importers/ply_header.h"
#include "alhazen/importers/text_cursor.h"
#include "alhazen/importers/triangulate.h"

namespace alhazen {

namespace {

constexpr int kMaxErrors = 20;

/// Values of an ascii body.
class AsciiValues {
  public:
    static constexpr std::size_t kListItemBytes = 2;

    AsciiValues(std::string_view bytes, const PlyHeader& header)
        : cursor_(bytes.substr(header.body_offset), header.body_line) {}

    bool read(PlyType, double& value) { return cursor_.skip_to_word() && cursor_.number(value); }
    bool skip(const PlyElement&) { return false; }
    [[nodiscard]] std::size_t bytes_left() const { return cursor_.bytes_left() + 1; }
    /// Of the next value.
    [[nodiscard]] FileLocation location(const std::string& file) const {
        TextCursor next = cursor_;
        next.skip_to_word();
        return next.location(file);
    }
    [[nodiscard]] std::string found() const {
        return cursor_.at_end() ? "the end of the file" : cursor_.shown_word();
    }

  private:
    TextCursor cursor_;
};

template <class T>
T load(const char* bytes, bool swap) {
    char copy[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i) copy[i] = bytes[swap ? sizeof(T) - 1 - i : i];
    T value;
    std::memcpy(&value, copy, sizeof(T));
    return value;
}

/// Values of a binary body.
class BinaryValues {
  public:
    static constexpr std::size_t kListItemBytes = 1;

    BinaryValues(std::string_view bytes, const PlyHeader& header)
        : rest_(bytes.substr(header.body_offset)),
          swap_((header.format == PlyFormat::BigEndian) ==
                (std::endian::native == std::endian::little)) {}

    bool read(PlyType type, double& value) {
        const std::size_t size = size_of(type);
        if (rest_.size() < size) return false;
        value = decode(type, rest_.data());
        rest_.remove_prefix(size);
        return true;
    }
    /// Jumps over all items of an element without lists (there are enough bytes: that was checked).
    bool skip(const PlyElement& element) {
        for (const PlyProperty& property : element.properties) {
            if (property.count_type) return false;
        }
        rest_.remove_prefix(element.count * element.min_bytes(PlyFormat::LittleEndian));
        return true;
    }
    [[nodiscard]] std::size_t bytes_left() const { return rest_.size(); }
    [[nodiscard]] FileLocation location(const std::string& file) const { return {file, 0, 0}; }
    [[nodiscard]] std::string found() const { return "the end of the file"; }

  private:
    double decode(PlyType type, const char* p) const {
        switch (type) {
            case PlyType::Int8:
                return load<std::int8_t>(p, swap_);
            case PlyType::Uint8:
                return load<std::uint8_t>(p, swap_);
            case PlyType::Int16:
                return load<std::int16_t>(p, swap_);
            case PlyType::Uint16:
                return load<std::uint16_t>(p, swap_);
            case PlyType::Int32:
                return load<std::int32_t>(p, swap_);
            case PlyType::Uint32:
                return load<std::uint32_t>(p, swap_);
            case PlyType::Float32:
                return double(load<float>(p, swap_));
            case PlyType::Float64:
                return load<double>(p, swap_);
        }
        return 0.0;
    }

    std::string_view rest_;
    bool swap_;
};

/// What a vertex property is for: 0-2 position, 3-5 normal, 6-7 texture coordinates, 8 nothing.
constexpr int kUnused = 8;
int slot_of(const PlyProperty& property) {
    static constexpr std::array<std::pair<std::string_view, int>, 12> kSlots{{{"x", 0},
                                                                              {"y", 1},
                                                                              {"z", 2},
                                                                              {"nx", 3},
                                                                              {"ny", 4},
                                                                              {"nz", 5},
                                                                              {"u", 6},
                                                                              {"v", 7},
                                                                              {"s", 6},
                                                                              {"t", 7},
                                                                              {"texture_u", 6},
                                                                              {"texture_v", 7}}};
    if (property.count_type) return kUnused;
    for (const auto& [name, slot] : kSlots) {
        if (property.name == name) return slot;
    }
    return kUnused;
}

template <class Values>
class BodyReader {
  public:
    BodyReader(std::string_view bytes, const PlyHeader& header, const std::string& file,
               const ImportOptions& options, Diagnostics& diagnostics)
        : header_(header),
          values_(bytes, header),
          file_(file),
          options_(options),
          diagnostics_(diagnostics) {}

    TriangleMesh read() {
        std::optional<Values> faces;  // where they start, when they come before the vertices
        const PlyElement* late_face = nullptr;
        bool has_vertices = false;
        for (const PlyElement& element : header_.elements) {
            if (!fits(element)) return {};
            bool good = true;
            if (element.name == "vertex" && !has_vertices) {
                good = read_vertices(element);
                has_vertices = true;
            } else if (element.name == "face" && has_vertices) {
                good = read_faces(element);
            } else {
                if (element.name == "face" && !late_face) {
                    faces = values_;
                    late_face = &element;
                }
                good = skip(element);
            }
            if (!good) return {};
        }
        if (late_face && has_vertices) {
            values_ = *faces;
            if (!read_faces(*late_face)) return {};
        }
        return finish(has_vertices);
    }

  private:
    /// The counts of the header are believed only as far as there are bytes.
    bool fits(const PlyElement& element) {
        const std::size_t least = element.min_bytes(header_.format);
        if (least != 0 && element.count > values_.bytes_left() / least) {
            diagnostics_.error(element.location, "element " + element.name + ": " +
                                                     std::to_string(element.count) +
                                                     " items need more bytes than the file has");
            return false;
        }
        const bool kept = element.name == "vertex" || element.name == "face";
        if (kept && (element.count > options_.max_elements || element.count > 0xFFFFFFFFu)) {
            throw Error(ErrorKind::Resource,
                        "element " + element.name + ": more than " +
                            std::to_string(options_.max_elements) + " items",
                        element.location);
        }
        return true;
    }

    bool read_vertices(const PlyElement& element) {
        std::vector<int> slots;
        std::array<bool, kUnused + 1> present{};
        for (const PlyProperty& property : element.properties) {
            slots.push_back(slot_of(property));
            present[std::size_t(slots.back())] = true;
        }
        if (!present[0] || !present[1] || !present[2]) {
            diagnostics_.error(element.location, "element vertex needs the properties x, y and z");
            return false;
        }
        const bool normals = present[3] && present[4] && present[5];
        const bool uvs = present[6] && present[7];
        mesh_.positions.reserve(element.count);
        if (normals) mesh_.normals.reserve(element.count);
        if (uvs) mesh_.uvs.reserve(element.count);
        std::array<double, kUnused + 1> v{};
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (std::size_t k = 0; k < slots.size(); ++k) {
                if (!read_property(element, element.properties[k], i, v[std::size_t(slots[k])])) {
                    return false;
                }
            }
            if (!is_finite(Vec3{v[0], v[1], v[2]})) {
                return fail(element, i, "a position that is not finite", values_);
            }
            mesh_.positions.push_back({v[0], v[1], v[2]});
            if (normals) mesh_.normals.push_back({v[3], v[4], v[5]});
            if (uvs) mesh_.uvs.push_back({v[6], v[7]});
        }
        return true;
    }

    bool read_faces(const PlyElement& element) {
        std::size_t list = element.properties.size();
        for (std::size_t k = 0; k < element.properties.size(); ++k) {
            const PlyProperty& p = element.properties[k];
            if (p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index")) list = k;
        }
        if (list == element.properties.size()) {
            diagnostics_.error(element.location, "element face needs the list vertex_indices");
            return false;
        }
        mesh_.triangles.reserve(mesh_.triangles.size() + element.count);
        double unused = 0.0;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (std::size_t k = 0; k < element.properties.size(); ++k) {
                const PlyProperty& property = element.properties[k];
                const bool good = k == list ? read_polygon(element, property, i)
                                            : read_property(element, property, i, unused);
                if (!good) return false;
            }
        }
        return errors_ == 0;
    }

    bool read_polygon(const PlyElement& element, const PlyProperty& property, std::uint64_t item) {
        const Values start = values_;
        std::uint64_t count = 0;
        if (!read_length(element, property, item, count)) return false;
        polygon_.clear();
        bool in_range = true;
        for (std::uint64_t k = 0; k < count; ++k) {
            double index = 0.0;
            if (!read_value(element, property.type, item, index)) return false;
            in_range = in_range && index >= 0.0 && index < double(mesh_.positions.size()) &&
                       index == std::floor(index);
            polygon_.push_back(in_range ? std::uint32_t(index) : 0);
        }
        if (!in_range) {
            diagnostics_.error(start.location(file_),
                               "face " + std::to_string(item) +
                                   ": a vertex index that is not below the " +
                                   std::to_string(mesh_.positions.size()) + " vertices");
            return ++errors_ < kMaxErrors;
        }
        if (count < 3) {
            ++small_faces_;
        } else if (!triangulate(mesh_.positions, polygon_, mesh_.triangles)) {
            diagnostics_.error(start.location(file_),
                               "face " + std::to_string(item) + ": a concave polygon of " +
                                   std::to_string(count) + " vertices; the limit is " +
                                   std::to_string(kMaxConcaveVertices));
            return ++errors_ < kMaxErrors;
        }
        return true;
    }

    bool skip(const PlyElement& element) {
        // Without properties there is nothing to read, however many there are.
        if (element.properties.empty() || values_.skip(element)) return true;
        double unused = 0.0;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const PlyProperty& property : element.properties) {
                if (!read_property(element, property, i, unused)) return false;
            }
        }
        return true;
    }

    /// Reads a value into `value`, or steps over a list.
    bool read_property(const PlyElement& element, const PlyProperty& property, std::uint64_t item,
                       double& value) {
        if (!property.count_type) return read_value(element, property.type, item, value);
        std::uint64_t count = 0;
        if (!read_length(element, property, item, count)) return false;
        double unused = 0.0;
        for (std::uint64_t k = 0; k < count; ++k) {
            if (!read_value(element, property.type, item, unused)) return false;
        }
        return true;
    }
    bool read_length(const PlyElement& element, const PlyProperty& property, std::uint64_t item,
                     std::uint64_t& count) {
        double length = 0.0;
        const Values start = values_;
        if (!read_value(element, *property.count_type, item, length)) return false;
        if (!(length >= 0.0) || length != std::floor(length)) {
            return fail(element, item, "a list whose length is no whole number", start);
        }
        if (length > double(values_.bytes_left() / Values::kListItemBytes)) {
            return fail(element, item, "a list longer than the rest of the file", start);
        }
        count = std::uint64_t(length);
        return true;
    }
    bool read_value(const PlyElement& element, PlyType type, std::uint64_t item, double& value) {
        if (values_.read(type, value)) return true;
        return fail(element, item, "expected a number, found " + values_.found(), values_);
    }
    bool fail(const PlyElement& element, std::uint64_t item, const std::string& message,
              const Values& at) {
        diagnostics_.error(at.location(file_),
                           element.name + " " + std::to_string(item) + ": " + message);
        return false;
    }

    TriangleMesh finish(bool has_vertices) {
        const FileLocation whole{file_, 0, 0};
        if (!has_vertices) {
            diagnostics_.error(whole, "the PLY file has no element vertex");
            return {};
        }
        if (small_faces_ != 0) {
            diagnostics_.warning(whole, std::to_string(small_faces_) +
                                            " faces with fewer than three vertices are ignored");
        }
        if (mesh_.triangles.empty()) diagnostics_.warning(whole, "the mesh has no faces");
        make_normals_unit(mesh_);
        return std::move(mesh_);
    }

    const PlyHeader& header_;
    Values values_;
    const std::string& file_;
    const ImportOptions& options_;
    Diagnostics& diagnostics_;
    TriangleMesh mesh_;
    std::vector<std::uint32_t> polygon_;
    std::uint64_t small_faces_ = 0;
    int errors_ = 0;
};

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& file, const ImportOptions& options,
                      Diagnostics& diagnostics) {
    const std::optional<PlyHeader> header = read_ply_header(bytes, file, diagnostics);
    if (!header) return {};
    if (header->format == PlyFormat::Ascii) {
        return BodyReader<AsciiValues>(bytes, *header, file, options, diagnostics).read();
    }
    return BodyReader<BinaryValues>(bytes, *header, file, options, diagnostics).read();
}

}  // namespace alhazen
