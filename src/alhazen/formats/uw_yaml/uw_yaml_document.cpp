#include "alhazen/formats/uw_yaml/uw_yaml_document.h"

#include "alhazen/formats/text/text_cursor.h"

#include <yaml-cpp/depthguard.h>

#include <algorithm>
#include <array>
#include <vector>

namespace alhazen {

namespace {

FileLocation place(const std::string& file, const YAML::Mark& mark) {
    return mark.is_null() ? FileLocation{file, 0, 0}
                          : FileLocation{file, mark.line + 1, mark.column + 1};
}

/// Tracks the nesting of a text line by line before the recursive parser runs. Brackets in quotes,
/// comments and the middle of plain scalars do not count; those at the beginning of the lines of a
/// block scalar do. Nesting that is missed is harmless: the parser has its own guard.
class NestingScan {
  public:
    /// The maximum nesting in the line. Precondition: all previous lines were passed.
    std::size_t depth_of(std::string_view line) {
        std::size_t at = 0;
        bool begins = true;  // a value may begin here
        if (quote_ != 0) {
            at = after_quote(line, 0);
            begins = false;
        } else {
            const std::size_t indent = line.find_first_not_of(" \t\r");
            if (indent == std::string_view::npos || line[indent] == '#') return 0;
            at = indent;
            if (flow_ == 0 && !pass_indicators(line, at)) return columns_.size();
        }
        std::size_t deepest = flow_;
        while (at < line.size()) {
            const char c = line[at];
            if (c == '#' && (at == 0 || is_blank(line[at - 1]))) break;
            if (is_blank(c)) {
                ++at;
            } else if (begins && (c == '"' || c == '\'')) {
                quote_ = c;
                at = after_quote(line, at + 1);
                begins = false;
            } else if ((c == '[' || c == '{') && (begins || flow_ > 0)) {
                deepest = std::max(deepest, ++flow_);
                begins = true;
                ++at;
            } else if ((c == ']' || c == '}') && flow_ > 0) {
                --flow_;
                begins = false;
                ++at;
            } else if (begins && (c == '&' || c == '!')) {  // an anchor, a tag
                at = std::min(line.find_first_of(" \t\r", at), line.size());
            } else {
                begins = (c == ',' && flow_ > 0) || (c == ':' && ends_word(line, at)) ||
                         (begins && (c == '-' || c == '?') && ends_word(line, at));
                ++at;
            }
        }
        return columns_.size() + deepest;
    }

  private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
    static bool ends_word(std::string_view line, std::size_t at) {
        return at + 1 == line.size() || is_blank(line[at + 1]);
    }

    /// Notes the columns of a block's nodes in the line; false if nothing follows them.
    bool pass_indicators(std::string_view line, std::size_t& at) {
        for (;; at = line.find_first_not_of(' ', at + 1)) {
            if (at == std::string_view::npos) return false;
            while (!columns_.empty() && columns_.back() >= at) columns_.pop_back();
            columns_.push_back(at);
            const bool indicator = line[at] == '-' || line[at] == '?' || line[at] == ':';
            if (!indicator || (at + 1 < line.size() && line[at + 1] != ' ')) return true;
        }
    }

    /// The place behind the quote that is open at `at`; the line's end if it stays open.
    std::size_t after_quote(std::string_view line, std::size_t at) {
        for (; at < line.size(); ++at) {
            const bool escapes = quote_ == '"' ? line[at] == '\\' : line.substr(at, 2) == "''";
            if (escapes) {
                ++at;
            } else if (line[at] == quote_) {
                quote_ = 0;
                return at + 1;
            }
        }
        return line.size();
    }

    std::vector<std::size_t> columns_;
    std::size_t flow_ = 0;
    char quote_ = 0;  ///< of the quoted scalar that is open at the end of the line, or 0
};

void check_nesting(std::string_view bytes, const std::string& file, int max_nesting) {
    NestingScan scan;
    int line = 1;
    for (std::size_t at = 0; at < bytes.size(); ++line) {
        const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
        if (scan.depth_of(bytes.substr(at, end - at)) > std::size_t(max_nesting)) {
            throw Error(ErrorKind::Scene,
                        "nested more than " + std::to_string(max_nesting) + " deep",
                        {file, line, 0});
        }
        at = end + 1;
    }
}

}  // namespace

std::optional<YAML::Node> parse_yaml(std::string_view bytes, const std::string& file,
                                     int max_nesting, Diagnostics& diagnostics) {
    if (bytes.size() > kMaxYamlBytes) {
        throw Error(ErrorKind::Resource,
                    "YAML text of more than " + std::to_string(kMaxYamlBytes >> 20) + " MiB",
                    {file, 0, 0});
    }
    check_nesting(bytes, file, max_nesting);
    try {
        const std::vector<YAML::Node> documents = YAML::LoadAll(std::string(bytes));
        for (std::size_t i = 1; i < documents.size(); ++i) {
            if (documents[i].IsNull()) continue;
            diagnostics.warning(place(file, documents[i].Mark()),
                                "another YAML document in the file is not read");
            break;
        }
        return documents.empty() ? YAML::Node() : documents.front();
    } catch (const YAML::DeepRecursion& e) {
        throw Error(ErrorKind::Scene, "nested more than " + std::to_string(max_nesting) + " deep",
                    place(file, e.mark));
    } catch (const YAML::Exception& e) {
        diagnostics.error(place(file, e.mark), "not valid YAML: " + e.msg);
        return std::nullopt;
    }
}

FileLocation YamlValues::location(const YAML::Node& node) const {
    return node.IsDefined() ? place(file_, node.Mark()) : FileLocation{file_, 0, 0};
}
void YamlValues::error(const YAML::Node& node, const std::string& message) {
    diagnostics_.error(location(node), message);
}
void YamlValues::warning(const YAML::Node& node, const std::string& message) {
    diagnostics_.warning(location(node), message);
}

YAML::Node YamlValues::find(const YAML::Node& map, const char* key) {
    if (!map.IsDefined() || !map.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    // Explicit search: the operator of yaml-cpp would convert every key.
    for (const auto& entry : map) {
        if (entry.first.IsScalar() && entry.first.Scalar() == key) return entry.second;
    }
    return YAML::Node(YAML::NodeType::Undefined);
}

void YamlValues::warn_once(const YAML::Node& key, const std::string& message) {
    if (warned_.size() < 1000 && warned_.insert(message).second) warning(key, message);
}

void YamlValues::check_keys(const YAML::Node& map, const std::string& what,
                            std::span<const std::string_view> known, const char* of_two) {
    if (!map.IsDefined() || map.IsNull()) return;
    if (!checked_.emplace(map.Mark().pos, what).second) return;
    if (!map.IsMap()) return error(map, "'" + what + "' must be a map");
    std::set<std::string> seen;
    for (const auto& entry : map) {
        const YAML::Node& key = entry.first;
        if (!key.IsScalar()) {
            warn_once(key, "a key of '" + what + "' that is no text is ignored");
            continue;
        }
        const std::string& name = key.Scalar();
        const std::string shown = "'" + name.substr(0, 60) + "'";
        if (name == "<<") {
            error(key, "merge keys (<<) are not supported; repeat what they merge");
        } else if (!seen.insert(name).second) {
            warn_once(key, shown + " is given twice in '" + what + "'; " + of_two);
        } else if (!known.empty() && std::find(known.begin(), known.end(), name) == known.end()) {
            warn_once(key, "the key " + shown + " of '" + what + "' is not known; ignored");
        }
    }
}

std::optional<double> YamlValues::number_of(const YAML::Node& node) {
    if (!node.IsScalar()) return std::nullopt;
    double value = 0.0;
    TextCursor cursor(node.Scalar());
    if (!cursor.number(value) || !cursor.at_end()) return std::nullopt;
    return value;
}

std::optional<bool> YamlValues::flag_of(const YAML::Node& node) {
    bool value = false;
    if (!YAML::convert<bool>::decode(node, value)) return std::nullopt;
    return value;
}

double YamlValues::number(const YAML::Node& map, const char* key, double missing) {
    const YAML::Node node = find(map, key);
    if (!node.IsDefined()) return missing;
    if (const std::optional<double> value = number_of(node)) return *value;
    error(node, std::string("'") + key + "' must be a finite number");
    return missing;
}

bool YamlValues::flag(const YAML::Node& map, const char* key, bool missing) {
    const YAML::Node node = find(map, key);
    if (!node.IsDefined()) return missing;
    if (const std::optional<bool> value = flag_of(node)) return *value;
    error(node, std::string("'") + key + "' must be true or false");
    return missing;
}

std::string YamlValues::text(const YAML::Node& map, const char* key) {
    const YAML::Node node = find(map, key);
    if (!node.IsDefined() || node.IsNull()) return {};
    if (node.IsScalar()) return node.Scalar();
    error(node, std::string("'") + key + "' must be a text");
    return {};
}

Vec3 YamlValues::vector(const YAML::Node& map, const char* key, double missing) {
    const YAML::Node node = find(map, key);
    if (node.IsDefined() && !node.IsMap()) {
        error(node, std::string("'") + key + "' must have X, Y and Z");
    } else {
        check_keys(node, key, {"X", "Y", "Z"});
    }
    return {number(node, "X", missing), number(node, "Y", missing), number(node, "Z", missing)};
}

Rgb YamlValues::color(const YAML::Node& map, const char* key) {
    const YAML::Node node = find(map, key);
    if (node.IsDefined() && !node.IsMap()) {
        error(node, std::string("'") + key + "' must have R, G and B");
    } else {
        check_keys(node, key, {"R", "G", "B", "A"});
    }
    return {number(node, "R", 0.0), number(node, "G", 0.0), number(node, "B", 0.0)};
}

}  // namespace alhazen
