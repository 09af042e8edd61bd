#include "alhazen/formats/stl/stl_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <memory>

#include "alhazen/base/interruption.h"
#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/mesh/vertex_welder.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

constexpr int kMaxStlErrors = 20;
constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

bool is_word(std::string_view word, std::string_view expected) {
    return word.size() == expected.size() &&
           std::equal(word.begin(), word.end(), expected.begin(), [](char a, char b) {
               return std::tolower(static_cast<unsigned char>(a)) == b;
           });
}

std::uint32_t u32(const char* bytes) {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

/// File size that corresponds to the count of a binary file.
std::uint64_t binary_size(std::string_view bytes) {
    return kHeaderBytes + kFacetBytes * std::uint64_t{u32(bytes.data() + 80)};
}

bool is_exact_binary(std::string_view bytes) {
    return bytes.size() >= kHeaderBytes && binary_size(bytes) == bytes.size();
}

bool begins_with_solid(std::string_view bytes) {
    TextCursor cursor(bytes.substr(0, 4096));
    return cursor.skip_to_word() && is_word(cursor.word(), "solid");
}

/// Moves to the first "facet normal" with something behind it on this line; false, not moved, if
/// there is none. Files of one line have it behind the name of a solid.
bool skip_to_facet_in_line(TextCursor& cursor) {
    TextCursor at = cursor;
    const std::int64_t line = at.line();
    while (at.skip_blanks() && at.line() == line) {
        const TextCursor start = at;
        if (!is_word(at.word(), "facet")) continue;
        TextCursor ahead = at;
        if (ahead.skip_blanks() && is_word(ahead.word(), "normal") && ahead.skip_blanks() &&
            ahead.line() == line) {
            cursor = start;
            return true;
        }
    }
    return false;
}

/// True for "solid" followed by a statement of ascii STL.
bool is_ascii(std::string_view bytes) {
    if (!begins_with_solid(bytes)) return false;
    TextCursor cursor(bytes.substr(0, 65536));
    cursor.skip_to_word();
    cursor.word();
    if (skip_to_facet_in_line(cursor)) return true;
    cursor.skip_line();
    if (!cursor.skip_to_word()) return false;
    const std::string_view word = cursor.word();
    return is_word(word, "facet") || is_word(word, "endsolid");
}

/// Binary files that begin with "solid" have early zero bytes: at the end of the header or in a
/// coordinate. Text has none.
bool has_zero_byte(std::string_view bytes) {
    return bytes.substr(0, 65536).find('\0') != std::string_view::npos;
}

class StlReader {
  public:
    StlReader(std::string_view bytes, const std::string& file, const ImportOptions& options,
              Diagnostics& diagnostics, bool as_one)
        : bytes_(bytes),
          file_(file),
          options_(options),
          diagnostics_(diagnostics),
          as_one_(as_one) {}

    std::vector<StlSolid> read() {
        if (is_exact_binary(bytes_)) {
            read_binary(u32(bytes_.data() + 80));
        } else if (is_ascii(bytes_) || (begins_with_solid(bytes_) && !has_zero_byte(bytes_))) {
            read_ascii();
        } else {
            read_damaged_binary();
        }
        if (errors_ != 0) return {};
        if (2 * turned_ > facets_ && turned_ != 0) {
            diagnostics_.warning({file_, 0, 0},
                                 std::to_string(turned_) + " of " + std::to_string(facets_) +
                                     " facets have a normal against their winding; the winding "
                                     "counts");
        }
        welder_.reset();
        for (StlSolid& solid : solids_) {
            std::vector<Vec3>& positions = solid.mesh.positions;
            if (positions.capacity() > positions.size() + positions.size() / 4) {
                positions.shrink_to_fit();
            }
        }
        return std::move(solids_);
    }

  private:
    void read_damaged_binary() {
        if (report_wide_text(bytes_, file_, diagnostics_)) return;
        const std::string size = std::to_string(bytes_.size());
        if (bytes_.size() < kHeaderBytes) {
            return error({file_, 0, 0}, "not an STL file: " + size +
                                            " bytes; binary ones have at least 84, ascii ones "
                                            "begin with 'solid'");
        }
        const std::uint64_t expected = binary_size(bytes_);
        const std::uint32_t count = u32(bytes_.data() + 80);
        if (bytes_.size() > expected && bytes_.size() - expected < kFacetBytes && count != 0) {
            diagnostics_.warning({file_, 0, 0}, std::to_string(bytes_.size() - expected) +
                                                    " bytes behind the last facet are ignored");
            return read_binary(count);
        }
        error({file_, 0, 0}, "a binary STL of " + std::to_string(count) + " facets has " +
                                 std::to_string(expected) + " bytes; the file has " + size);
    }

    void read_binary(std::uint32_t count) {
        check_count(count);
        // Euler: a closed surface of genus 0 has two vertices more than half its triangles.
        begin_solid(header_name(), 0, count / 2 + 2);
        StlSolid& solid = solids_.back();
        solid.mesh.triangles.reserve(count);
        const char* at = bytes_.data() + kHeaderBytes;
        for (std::uint32_t i = 0; i < count && errors_ < kMaxStlErrors; ++i, at += kFacetBytes) {
            interruption_point();
            std::array<Vec3, 4> v;
            for (std::size_t k = 0; k < 12; ++k) {
                v[k / 3][int(k % 3)] = double(std::bit_cast<float>(u32(at + 4 * k)));
            }
            if (is_finite(v[1]) && is_finite(v[2]) && is_finite(v[3])) {
                add_facet(v[0], v[1], v[2], v[3]);
            } else {
                error({file_, 0, 0},
                      "facet " + std::to_string(i) + ": a position that is not finite");
            }
        }
    }
    /// The text at the start of a binary file, if it is text.
    [[nodiscard]] std::string header_name() const {
        std::string_view header = bytes_.substr(0, 80);
        header = header.substr(0, header.find('\0'));
        const auto printable = [](char c) { return c >= 0x20 && c < 0x7f; };
        if (!std::all_of(header.begin(), header.end(), printable)) return {};
        while (!header.empty() && header.back() == ' ') header.remove_suffix(1);
        if (header == kStlHeader) return {};
        if (header.starts_with("solid ")) header.remove_prefix(6);
        return std::string(header);
    }

    void read_ascii() {
        TextCursor cursor(bytes_);
        while (errors_ < kMaxStlErrors && cursor.skip_to_word()) {
            const TextCursor start = cursor;
            const std::string_view word = cursor.word();
            if (is_word(word, "solid")) {
                std::string_view name = rest_before_facet(cursor);
                while (!name.empty() && TextCursor::is_blank(name.front())) name.remove_prefix(1);
                while (!name.empty() && TextCursor::is_blank(name.back())) name.remove_suffix(1);
                begin_solid(std::string(name), start.location(file_).line, 64);
            } else if (is_word(word, "facet")) {
                if (solids_.empty()) begin_solid("", start.location(file_).line, 64);
                if (!read_facet(cursor)) skip_facet(cursor);
                check_count(facets_);
            } else if (is_word(word, "endsolid")) {
                skip_end(cursor);
            } else {
                error(start.location(file_),
                      "expected facet or endsolid, found " + start.shown_word());
                skip_facet(cursor);
            }
        }
        // Solids without facets are invisible.
        std::erase_if(solids_, [](const StlSolid& s) { return s.mesh.triangles.empty(); });
    }
    /// The rest of the line, at most up to a facet in it.
    static std::string_view rest_before_facet(TextCursor& cursor) {
        TextCursor name = cursor;
        if (!skip_to_facet_in_line(cursor)) return cursor.rest_of_line();
        return name.characters(name.bytes_left() - cursor.bytes_left());
    }
    /// Skips the name behind `endsolid`: up to the end of the line, or to the next solid of a file
    /// of one line.
    static void skip_end(TextCursor& cursor) {
        TextCursor facet = cursor;
        if (!skip_to_facet_in_line(facet)) return cursor.skip_line();
        for (TextCursor at = cursor; at.skip_blanks() && at.bytes_left() > facet.bytes_left();) {
            const TextCursor start = at;
            if (!is_word(at.word(), "solid")) continue;
            cursor = start;
            return;
        }
        cursor = facet;
    }
    bool read_facet(TextCursor& cursor) {
        std::array<Vec3, 4> v;
        if (!expect(cursor, "normal")) return false;
        for (int k = 0; k < 3; ++k) {
            // Normals are ignored: those of slivers are often NaN.
            if (cursor.skip_to_word() && !cursor.number(v[0][k])) cursor.word();
        }
        if (!expect(cursor, "outer") || !expect(cursor, "loop")) return false;
        for (std::size_t i = 1; i < 4; ++i) {
            if (!expect(cursor, "vertex")) return false;
            for (int k = 0; k < 3; ++k) {
                if (!cursor.skip_to_word() || !cursor.number(v[i][k])) {
                    return mistake(cursor, "a number");
                }
            }
        }
        if (!expect(cursor, "endloop") || !expect(cursor, "endfacet")) return false;
        add_facet(v[0], v[1], v[2], v[3]);
        return true;
    }
    bool expect(TextCursor& cursor, std::string_view word) {
        if (!cursor.skip_to_word()) return mistake(cursor, std::string(word));
        TextCursor ahead = cursor;
        if (!is_word(ahead.word(), word)) return mistake(cursor, std::string(word));
        cursor = ahead;
        return true;
    }
    bool mistake(const TextCursor& cursor, const std::string& expected) {
        error(cursor.location(file_),
              "facet " + std::to_string(facets_) + ": expected " + expected + ", found " +
                  (cursor.at_end() ? "the end of the file" : cursor.shown_word()));
        return false;
    }
    static void skip_facet(TextCursor& cursor) {
        while (cursor.skip_to_word()) {
            if (is_word(cursor.word(), "endfacet")) return;
        }
    }

    void begin_solid(std::string name, int line, std::size_t expected) {
        if (as_one_ && !solids_.empty()) return;
        // Vertices are merged within a solid only; its table is created at its first facet.
        welder_.reset();
        expected_ = expected;
        if (!solids_.empty() && solids_.back().mesh.triangles.empty()) solids_.pop_back();
        solids_.push_back({std::move(name), line, {}});
    }
    void add_facet(const Vec3& normal, const Vec3& a, const Vec3& b, const Vec3& c) {
        if (!welder_) {
            // The list of solids does not grow while the table is in use.
            mesh_ = &solids_.back().mesh;
            welder_ = std::make_unique<VertexWelder>(*mesh_, expected_);
        }
        const std::uint32_t i = welder_->find_or_add(a);
        const std::uint32_t j = welder_->find_or_add(b);
        mesh_->triangles.push_back({i, j, welder_->find_or_add(c)});
        ++facets_;
        if (dot(normal, cross(b - a, c - a)) < 0.0) ++turned_;
    }
    void check_count(std::uint64_t count) {
        if (count <= options_.max_elements && 3 * count < 0xFFFFFFFFu) return;
        throw Error(
            ErrorKind::Resource,
            "more than " +
                std::to_string(std::min<std::uint64_t>(options_.max_elements, 0xFFFFFFFFu / 3)) +
                " facets",
            {file_, 0, 0});
    }
    void error(FileLocation where, const std::string& message) {
        diagnostics_.error(std::move(where), message);
        ++errors_;
    }

    std::string_view bytes_;
    const std::string& file_;
    const ImportOptions& options_;
    Diagnostics& diagnostics_;
    bool as_one_;
    std::vector<StlSolid> solids_;
    TriangleMesh* mesh_ = nullptr;
    std::unique_ptr<VertexWelder> welder_;
    std::size_t expected_ = 64;
    std::uint64_t facets_ = 0, turned_ = 0;
    int errors_ = 0;
};

}  // namespace

bool looks_like_stl(std::string_view bytes) {
    return (is_exact_binary(bytes) && bytes.size() > kHeaderBytes) || is_ascii(bytes);
}

std::vector<StlSolid> read_stl(std::string_view bytes, const std::string& file,
                               const ImportOptions& options, Diagnostics& diagnostics,
                               bool as_one) {
    return StlReader(bytes, file, options, diagnostics, as_one).read();
}

}  // namespace alhazen
