#include "alhazen/formats/ply/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "alhazen/base/interruption.h"
#include "alhazen/formats/mesh/mesh_normals.h"
#include "alhazen/formats/ply/ply_header.h"
#include "alhazen/formats/ply/ply_values.h"
#include "alhazen/formats/ply/ply_vertices.h"
#include "alhazen/geometry/polygon/free_diagonals.h"
#include "alhazen/geometry/polygon/triangulate.h"

namespace alhazen {

namespace {

constexpr int kMaxPlyErrors = 20;

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
        // Starting positions of faces that precede the vertices.
        std::vector<std::pair<const PlyElement*, Values>> early;
        bool has_vertices = false;
        for (const PlyElement& element : header_.elements) {
            if (!fits(element)) return {};
            const bool faces = element.name == "face" || element.name == "tristrips";
            bool good = true;
            if (element.name == "vertex" && !has_vertices) {
                good = read_vertices(element);
                has_vertices = true;
            } else if (faces && has_vertices) {
                good = read_faces(element);
            } else {
                if (faces) early.emplace_back(&element, values_);
                good = skip(element);
            }
            if (!good) return {};
        }
        end_ = values_;
        for (const auto& [element, start] : early) {
            if (!has_vertices) break;
            values_ = start;
            if (!read_faces(*element)) return {};
        }
        return errors_ == 0 ? finish(has_vertices) : TriangleMesh{};
    }

  private:
    /// Bounds the counts of the header by the bytes left.
    bool fits(const PlyElement& element) {
        const std::size_t least = element.min_bytes(header_.format);
        if (least != 0 && element.count > values_.bytes_left() / least) {
            diagnostics_.error(element.location, "element " + element.name + ": " +
                                                     std::to_string(element.count) +
                                                     " items need more bytes than the file has");
            return false;
        }
        const bool kept =
            element.name == "vertex" || element.name == "face" || element.name == "tristrips";
        if (kept && (element.count > options_.max_elements || element.count > 0xFFFFFFFFu)) {
            throw Error(ErrorKind::Resource,
                        "element " + element.name + ": more than " +
                            std::to_string(options_.max_elements) + " items",
                        element.location);
        }
        return true;
    }

    bool read_vertices(const PlyElement& element) {
        PlyVertexLayout layout(element, header_.exact);
        if (!layout.has_positions()) {
            diagnostics_.error(element.location, "element vertex needs the properties x, y and z");
            return false;
        }
        for (const std::string& oddity : layout.oddities()) {
            diagnostics_.warning(element.location, oddity);
        }
        layout.reserve(mesh_, element.count);
        return read_items(element, [&](std::uint64_t i) {
            const bool good = read_vertex(element, i, layout);
            layout.append(mesh_);
            return good;
        });
    }
    bool read_vertex(const PlyElement& element, std::uint64_t i, PlyVertexLayout& layout) {
        for (std::size_t k = 0; k < element.properties.size(); ++k) {
            if (!read_property(element, element.properties[k], i, layout.value(k))) return false;
        }
        if (is_finite(layout.position())) return true;
        return fail(element, i, "a position that is not finite", values_);
    }
    /// Reads the items of an element by `read(i)`; false if the rest cannot be read.
    ///
    /// An item of an ascii file is a line, and may be several lines (a number in each, wrapped
    /// lists) or, from the first on, a part of one. It fails where it takes the end of one line and
    /// only the beginning of another, or begins behind others where the first was a line. The last
    /// one fails also where it begins its line and others follow, if one item is known to be a
    /// line.
    template <class Read>
    bool read_items(const PlyElement& element, const Read& read) {
        const int errors = errors_;
        bool is_line = false;  // the first item
        for (std::uint64_t i = 0; i < element.count; ++i) {
            interruption_point();
            if constexpr (!Values::kHasLines) {
                if (!read(i)) return false;
            } else {
                const bool begins = values_.begins_line();
                const Values start = values_;
                const auto fail_line = [&](const char* message) {
                    values_ = start;
                    fail(element, i, message, start);
                    return recover();
                };
                const char* const more = "the line has more values than the header names";
                const auto surplus = [&] {
                    if (i > 0) --i;  // these values are of no item
                    return fail_line(more);
                };
                if (is_line && !begins) {
                    if (!surplus()) return false;
                    continue;
                }
                if (!read(i)) {
                    if (!recover()) return false;
                    continue;
                }
                const bool in_line = values_.line() == start.line(), ends = values_.ends_line();
                if (i == 0) is_line = begins && in_line && ends;
                const bool is_last = i + 1 == element.count && (is_line || errors_ > errors);
                if (is_last && begins && in_line && !ends) {
                    fail(element, i, more, values_);
                    return recover();
                }
                if (in_line || ends) continue;
                if (begins ? !fail_line("the line has fewer values than the header names")
                           : !surplus()) {
                    return false;
                }
            }
        }
        return true;
    }
    /// Recovers after an error if possible, to report further errors.
    bool recover() { return errors_ < kMaxPlyErrors && values_.recover(); }

    /// Index of the list of vertices among the properties of a face or strip.
    std::size_t find_list(const PlyElement& element) {
        const std::size_t none = element.properties.size();
        std::size_t list = none;
        for (std::size_t k = 0; k < none; ++k) {
            const PlyProperty& p = element.properties[k];
            if (!p.count_type || (p.name != "vertex_indices" && p.name != "vertex_index")) continue;
            if (list != none) {
                diagnostics_.warning(element.location,
                                     "a " + element.name + " has two lists of vertices; '" +
                                         element.properties[list].name + "' is ignored");
            }
            list = k;
        }
        return list;
    }

    bool read_faces(const PlyElement& element) {
        const std::size_t list = find_list(element);
        if (list == element.properties.size()) {
            diagnostics_.error(element.location,
                               "element " + element.name + " needs the list vertex_indices");
            return false;
        }
        for (const PlyProperty& property : element.properties) {
            if (property.name == "texcoord" || property.name == "red") {
                diagnostics_.warning(element.location,
                                     "'" + property.name + "' of a " + element.name +
                                         " is ignored; only those of vertices are read");
            }
        }
        const bool strips = element.name == "tristrips";
        if (!strips) mesh_.triangles.reserve(mesh_.triangles.size() + element.count);
        if (!read_items(element,
                        [&](std::uint64_t i) { return read_face(element, i, list, strips); })) {
            return false;
        }
        free_diagonals(mesh_.positions, polygons_, mesh_.triangles);
        polygons_.clear();
        return errors_ == 0;
    }
    bool read_face(const PlyElement& element, std::uint64_t i, std::size_t list, bool strips) {
        double unused = 0.0;
        for (std::size_t k = 0; k < element.properties.size(); ++k) {
            const PlyProperty& property = element.properties[k];
            const bool good = k != list ? read_property(element, property, i, unused)
                              : strips  ? read_strips(element, property, i)
                                        : read_polygon(element, property, i);
            if (!good) return false;
        }
        return true;
    }

    /// Reads one list of strips; -1 ends a strip. Every other triangle of a strip is reversed.
    bool read_strips(const PlyElement& element, const PlyProperty& property, std::uint64_t item) {
        std::uint64_t count = 0;
        if (!read_length(element, property, item, count)) return false;
        std::array<std::uint32_t, 2> last{};
        std::uint64_t in_strip = 0;
        for (std::uint64_t k = 0; k < count; ++k) {
            const Values start = values_;
            double index = 0.0;
            if (!read_value(element, property.type, item, index)) return false;
            if (index == -1.0 || index == double(0xFFFFFFFFu)) {
                in_strip = 0;
                continue;
            }
            if (!is_vertex(index)) {
                return bad_index(element, item, index == std::floor(index), start);
            }
            const std::uint32_t vertex = std::uint32_t(index);
            if (in_strip >= 2 && vertex != last[0] && vertex != last[1] && last[0] != last[1]) {
                const bool odd = in_strip % 2 != 0;
                mesh_.triangles.push_back({last[odd ? 1 : 0], last[odd ? 0 : 1], vertex});
            }
            last = {last[1], vertex};
            ++in_strip;
        }
        return true;
    }

    bool read_polygon(const PlyElement& element, const PlyProperty& property, std::uint64_t item) {
        const Values start = values_;
        std::uint64_t count = 0;
        if (!read_length(element, property, item, count)) return false;
        polygon_.clear();
        bool in_range = true, whole = true;
        for (std::uint64_t k = 0; k < count; ++k) {
            double index = 0.0;
            if (!read_value(element, property.type, item, index)) return false;
            in_range = in_range && is_vertex(index);
            polygon_.push_back(in_range ? std::uint32_t(index) : 0);
            whole = whole && index == std::floor(index);
        }
        // The item is read completely; the next one can be read.
        if (!in_range) {
            bad_index(element, item, whole, start);
            return errors_ < kMaxPlyErrors;
        }
        if (count < 3) {
            ++small_faces_;
        } else {
            const std::size_t first = mesh_.triangles.size();
            triangulate(mesh_.positions, polygon_, mesh_.triangles);
            if (count > 3) polygons_.push_back({first, mesh_.triangles.size()});
        }
        return true;
    }
    [[nodiscard]] bool is_vertex(double index) const {
        return index >= 0.0 && index < double(mesh_.positions.size()) && index == std::floor(index);
    }
    bool bad_index(const PlyElement& element, std::uint64_t item, bool whole, const Values& at) {
        return fail(element, item,
                    whole ? "a vertex index outside the range of " +
                                std::to_string(mesh_.positions.size()) + " vertices"
                          : "a vertex index that is not a whole number",
                    at);
    }

    bool skip(const PlyElement& element) {
        // Elements without properties occupy no bytes, whatever their count.
        if (element.properties.empty() || values_.skip(element)) return true;
        double unused = 0.0;
        return read_items(element,
                          [&](std::uint64_t i) {
                              const auto read = [&](const PlyProperty& property) {
                                  return read_property(element, property, i, unused);
                              };
                              return std::all_of(element.properties.begin(),
                                                 element.properties.end(), read);
                          }) &&
               errors_ == 0;
    }

    /// Reads a scalar into `value`, or skips a list.
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
            return fail(element, item, "a list length that is not a whole number", start);
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
        ++errors_;
        diagnostics_.error(at.location(file_),
                           element.name + " " + std::to_string(item) + ": " + message);
        return false;
    }

    /// Warns of data after the last element; `end_` is where that ends.
    void report_surplus() {
        const std::size_t surplus = end_->surplus_bytes();
        if (surplus == 0) return;
        diagnostics_.warning(end_->location(file_),
                             std::to_string(surplus) +
                                 (surplus == 1 ? " byte follows" : " bytes follow") +
                                 " the last element of the header, and " +
                                 (surplus == 1 ? "is" : "are") + " ignored");
    }

    /// Warns of colours beyond black and white, which only properties of a float type have.
    void report_unusual_colors() {
        std::size_t unusual = 0;
        float least = 0.0f, most = 1.0f;
        for (const VertexColor& c : mesh_.colors) {
            const auto [low, high] = std::minmax({c.r, c.g, c.b});
            unusual += low < 0.0f || high > 1.0f;
            least = std::min(least, low);
            most = std::max(most, high);
        }
        if (unusual == 0) return;
        diagnostics_.warning(
            {file_, 0, 0},
            fmt::format("{} of {} vertices have colours outside of 0 to 1, from {} to {}: those "
                        "of a float type are linear factors, 1 is white; path tracing takes 0 for "
                        "negative ones and scales down what reflects more than all light",
                        unusual, mesh_.colors.size(), least, most));
    }

    TriangleMesh finish(bool has_vertices) {
        const FileLocation whole{file_, 0, 0};
        if (!has_vertices) {
            diagnostics_.error(whole, "the PLY file has no element vertex");
            return {};
        }
        if (small_faces_ != 0 && mesh_.triangles.empty()) {
            std::string rest;
            if (const std::size_t surplus = end_->surplus_bytes(); surplus != 0) {
                rest = "; " + std::to_string(surplus) +
                       " bytes are left: does each line have the values that the header names?";
            }
            diagnostics_.error(end_->location(file_), "no face has three vertices or more" + rest);
            return {};
        }
        if (small_faces_ != 0) {
            diagnostics_.warning(whole, std::to_string(small_faces_) +
                                            " faces with fewer than three vertices are ignored");
        }
        report_surplus();
        if (!header_.exact) report_unusual_colors();
        if (!header_.exact) make_normals_unit(mesh_);
        return std::move(mesh_);
    }

    const PlyHeader& header_;
    Values values_;
    std::optional<Values> end_;  ///< after the last element
    const std::string& file_;
    const ImportOptions& options_;
    Diagnostics& diagnostics_;
    TriangleMesh mesh_;
    std::vector<std::uint32_t> polygon_;
    std::vector<PolygonTriangles> polygons_;  ///< of the element being read
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
