#include "alhazen/formats/ply/ply_header.h"

#include <array>
#include <utility>

#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

constexpr std::size_t kMaxElements = 256;
constexpr std::size_t kMaxProperties = 1024;

std::optional<PlyType> type_named(std::string_view name) {
    static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{{
        {"char", PlyType::Int8},
        {"int8", PlyType::Int8},
        {"uchar", PlyType::Uint8},
        {"uint8", PlyType::Uint8},
        {"short", PlyType::Int16},
        {"int16", PlyType::Int16},
        {"ushort", PlyType::Uint16},
        {"uint16", PlyType::Uint16},
        {"int", PlyType::Int32},
        {"int32", PlyType::Int32},
        {"uint", PlyType::Uint32},
        {"uint32", PlyType::Uint32},
        {"float", PlyType::Float32},
        {"float32", PlyType::Float32},
        {"double", PlyType::Float64},
        {"float64", PlyType::Float64},
    }};
    for (const auto& [known, type] : kNames) {
        if (known == name) return type;
    }
    return std::nullopt;
}

/// Reads the header line by line; `failed` ends it.
class HeaderReader {
  public:
    HeaderReader(std::string_view bytes, const std::string& file, Diagnostics& diagnostics)
        : bytes_(bytes), cursor_(bytes), file_(file), diagnostics_(diagnostics) {}

    std::optional<PlyHeader> read() {
        if (word() != "ply") {
            error("a PLY file starts with the line 'ply'");
            return std::nullopt;
        }
        for (;;) {
            end_line();
            if (failed_) return std::nullopt;
            if (cursor_.at_end()) {
                error("the header ends without 'end_header'");
                return std::nullopt;
            }
            const FileLocation at = cursor_.location(file_);
            const std::string_view statement = word();
            if (statement == "end_header") break;
            read_statement(statement, at);
        }
        end_line();
        if (!has_format_) error("the header has no 'format' line");
        if (failed_) return std::nullopt;
        header_.body_offset = bytes_.size() - cursor_.bytes_left();
        header_.body_line = cursor_.line();
        return std::move(header_);
    }

  private:
    void read_statement(std::string_view statement, const FileLocation& at) {
        if (statement == "format") {
            read_format();
        } else if (statement == "element") {
            read_element(at);
        } else if (statement == "property") {
            read_property();
        } else if (statement == "comment") {
            TextCursor comment = cursor_;
            comment.skip_blanks();
            header_.exact = header_.exact || comment.rest_of_line() == kPlyExact;
        } else if (!statement.empty() && statement != "obj_info") {
            diagnostics_.warning(at, "the header line is no PLY statement and is ignored");
        }
    }
    void read_format() {
        const std::string_view name = word();
        if (name == "ascii") {
            header_.format = PlyFormat::Ascii;
        } else if (name == "binary_little_endian") {
            header_.format = PlyFormat::LittleEndian;
        } else if (name == "binary_big_endian") {
            header_.format = PlyFormat::BigEndian;
        } else {
            error("unknown PLY format; expected ascii, binary_little_endian or binary_big_endian");
        }
        has_format_ = true;
        if (const std::string_view version = word(); version != "1.0") {
            error("unknown PLY version; expected 1.0");
        }
    }
    void read_element(const FileLocation& at) {
        PlyElement element{std::string(word()), 0, {}, at};
        std::int64_t count = 0;
        cursor_.skip_blanks();
        if (element.name.empty() || !cursor_.integer(count) || count < 0) {
            return error("expected 'element NAME COUNT', found " + cursor_.shown_word());
        }
        element.count = std::uint64_t(count);
        if (header_.elements.size() == kMaxElements)
            return error("too many elements in the header");
        header_.elements.push_back(std::move(element));
    }
    void read_property() {
        if (header_.elements.empty()) return error("a property before the first element");
        PlyProperty property;
        std::string_view type = word();
        if (type == "list") {
            property.count_type = type_named(word());
            if (!property.count_type) return error("unknown type of the length of a list");
            if (*property.count_type == PlyType::Float32 ||
                *property.count_type == PlyType::Float64) {
                return error("the length of a list must be of an integer type");
            }
            type = word();
        }
        const std::optional<PlyType> known = type_named(type);
        if (!known) {
            return error(
                "unknown property type; expected char, uchar, short, ushort, int, uint, "
                "float, double or list");
        }
        property.type = *known;
        property.name = std::string(word());
        if (property.name.empty()) return error("the property has no name");
        std::vector<PlyProperty>& properties = header_.elements.back().properties;
        if (properties.size() == kMaxProperties) return error("too many properties of one element");
        properties.push_back(std::move(property));
    }

    std::string_view word() {
        while (TextCursor::is_blank(cursor_.peek())) cursor_.take(cursor_.peek());
        return cursor_.word();
    }
    /// Ends the line with the line end of the file's first line: in a binary file, what looks like
    /// the second half of \r\n may be data.
    void end_line() {
        const std::size_t before = bytes_.size() - cursor_.bytes_left();
        const std::size_t at = bytes_.find_first_of("\r\n", before);
        if (first_newline_.empty() && at != std::string_view::npos) {
            first_newline_ = bytes_.substr(at, bytes_.substr(at, 2) == "\r\n" ? 2 : 1);
        }
        const std::int64_t line = cursor_.line() + 1;
        if (at == std::string_view::npos) {
            cursor_ = TextCursor(bytes_.substr(bytes_.size()), line);
        } else {
            const bool two = bytes_.substr(at, 2) == "\r\n" && first_newline_ != "\r";
            cursor_ = TextCursor(bytes_.substr(at + (two ? 2 : 1)), line);
        }
    }
    void error(const std::string& message) {
        diagnostics_.error(cursor_.location(file_), message);
        failed_ = true;
    }

    std::string_view bytes_;
    TextCursor cursor_;
    const std::string& file_;
    Diagnostics& diagnostics_;
    std::string_view first_newline_;
    PlyHeader header_;
    bool has_format_ = false;
    bool failed_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::Int8:
        case PlyType::Uint8:
            return 1;
        case PlyType::Int16:
        case PlyType::Uint16:
            return 2;
        case PlyType::Int32:
        case PlyType::Uint32:
        case PlyType::Float32:
            return 4;
        case PlyType::Float64:
            return 8;
    }
    return 8;
}

std::size_t PlyElement::min_bytes(PlyFormat format) const {
    std::size_t bytes = 0;
    for (const PlyProperty& property : properties) {
        const bool ascii = format == PlyFormat::Ascii;
        bytes += ascii ? 2 : size_of(property.count_type.value_or(property.type));
    }
    return bytes;
}

std::optional<PlyHeader> read_ply_header(std::string_view bytes, const std::string& file,
                                         Diagnostics& diagnostics) {
    if (report_wide_text(bytes, file, diagnostics)) return std::nullopt;
    return HeaderReader(bytes, file, diagnostics).read();
}

}  // namespace alhazen
