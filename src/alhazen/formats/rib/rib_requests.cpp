#include "alhazen/formats/rib/rib_requests.h"

#include <charconv>
#include <climits>
#include <cmath>

namespace alhazen {

namespace {

constexpr int kMaxRibErrors = 50;

bool is_rib_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}
bool begins_rib_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool continues_rib_word(char c) {
    return begins_rib_word(c) || (c >= '0' && c <= '9') || c == ':' || c == '.';
}
bool begins_rib_number(char c) {
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

}  // namespace

std::optional<double> RibRequest::number(std::size_t argument) const {
    if (argument >= arguments.size() || !is_numbers(argument) || count(argument) != 1) {
        return std::nullopt;
    }
    return numbers[arguments[argument].begin];
}

std::span<const double> RibRequest::list(std::size_t argument) const {
    if (argument >= arguments.size() || !is_numbers(argument)) return {};
    return std::span(numbers).subspan(arguments[argument].begin, count(argument));
}

const std::string* RibRequest::string(std::size_t argument) const {
    if (argument >= arguments.size() || is_numbers(argument) || count(argument) != 1) {
        return nullptr;
    }
    return &strings[arguments[argument].begin];
}

RibPlace RibRequestReader::place() const {
    const std::ptrdiff_t column = next_ - line_start_ + 1;
    return {line_, column > INT_MAX ? INT_MAX : int(column)};
}

bool RibRequestReader::read(RibRequest& request) {
    for (;;) {
        skip_space();
        if (next_ == end_) return false;
        if (errors_ >= kMaxRibErrors) {
            error(place(), "too many errors; the rest of the file is not read");
            return false;
        }
        request.place = place();
        request.arguments.clear();
        request.numbers.clear();
        request.strings.clear();
        bool good = at_word();
        if (good) {
            request.name = word();
        } else {
            error(place(), static_cast<unsigned char>(*next_) >= 0x80
                               ? "the file is in the binary encoding; expected RIB text"
                               : "expected the name of a request, found " + shown());
            if (static_cast<unsigned char>(*next_) >= 0x80) {
                next_ = end_;
                return false;
            }
        }
        for (skip_space(); next_ != end_ && !at_word(); skip_space()) {
            if (good) {
                good = read_argument(request);
            } else {
                while (next_ != end_ && !is_rib_space(*next_)) ++next_;
            }
        }
        if (good) return true;
    }
}

bool RibRequestReader::at_word() const {
    return begins_rib_word(*next_);
}

void RibRequestReader::skip_space() {
    while (next_ != end_) {
        if (*next_ == '#') {
            while (next_ != end_ && *next_ != '\n' && *next_ != '\r') ++next_;
        } else if (is_rib_space(*next_)) {
            const char c = *next_++;
            if (c == '\n' || (c == '\r' && (next_ == end_ || *next_ != '\n'))) {
                if (line_ < INT_MAX) ++line_;
                line_start_ = next_;
            }
        } else {
            return;
        }
    }
}

std::string_view RibRequestReader::word() {
    const char* const begin = next_;
    while (next_ != end_ && continues_rib_word(*next_)) ++next_;
    return {begin, std::size_t(next_ - begin)};
}

bool RibRequestReader::read_argument(RibRequest& request) {
    RibArgument argument;
    argument.place = place();
    bool good = false;
    if (*next_ == '"') {
        argument = {RibArgument::Kind::String, place(), request.strings.size(), 0};
        good = read_string(request);
        argument.end = request.strings.size();
    } else if (*next_ == '[') {
        const std::size_t strings = request.strings.size();
        argument = {RibArgument::Kind::Numbers, place(), request.numbers.size(), 0};
        good = read_array(request);
        argument.end = request.numbers.size();
        if (request.strings.size() > strings) {
            argument = {RibArgument::Kind::Strings, argument.place, strings,
                        request.strings.size()};
        }
    } else {
        argument = {RibArgument::Kind::Number, place(), request.numbers.size(), 0};
        good = read_number(request);
        argument.end = request.numbers.size();
    }
    if (good) request.arguments.push_back(argument);
    return good;
}

bool RibRequestReader::read_array(RibRequest& request) {
    const RibPlace start = place();
    const std::size_t strings = request.strings.size(), numbers = request.numbers.size();
    ++next_;
    for (skip_space(); next_ != end_ && *next_ != ']'; skip_space()) {
        if (*next_ != '"' && !begins_rib_number(*next_)) {
            error(place(), "expected a number, a string or ']', found " + shown());
            // Skips the rest of the array, which is no argument of the next request.
            while (next_ != end_ && *next_ != ']') {
                skip_space();
                if (next_ != end_ && *next_ != ']') ++next_;
            }
            if (next_ != end_) ++next_;
            return false;
        }
        if (!(*next_ == '"' ? read_string(request) : read_number(request))) return false;
        if (request.strings.size() > strings && request.numbers.size() > numbers) {
            error(place(), "an array holds numbers or strings, not both");
            return false;
        }
    }
    if (next_ == end_) {
        error(start, "the array that begins here has no ']'");
        return false;
    }
    ++next_;
    return true;
}

bool RibRequestReader::read_number(RibRequest& request) {
    const char* const begin = *next_ == '+' ? next_ + 1 : next_;
    double value = 0;
    const auto [stop, status] = std::from_chars(begin, end_, value);
    // Values below the range of double are zero.
    const bool small =
        status == std::errc::result_out_of_range &&
        std::string_view(begin, std::size_t(stop - begin)).find("e-") != std::string_view::npos;
    const bool good = (status == std::errc{} || small) && std::isfinite(value) &&
                      (stop == end_ || is_rib_space(*stop) || *stop == ']' || *stop == '[' ||
                       *stop == '"' || *stop == '#');
    if (!good) {
        error(place(), "expected a finite number, found " + shown());
        return false;
    }
    request.numbers.push_back(small ? 0.0 : value);
    next_ = stop;
    return true;
}

bool RibRequestReader::read_string(RibRequest& request) {
    const RibPlace start = place();
    std::string text;
    for (++next_; next_ != end_ && *next_ != '"'; ++next_) {
        if (*next_ == '\n') {
            if (line_ < INT_MAX) ++line_;
            line_start_ = next_ + 1;
        }
        if (*next_ == '\\' && next_ + 1 != end_) ++next_;
        text += *next_;
    }
    if (next_ == end_) {
        error(start, "the string that begins here has no end");
        return false;
    }
    ++next_;
    request.strings.push_back(std::move(text));
    return true;
}

std::string RibRequestReader::shown() const {
    std::string text = "'";
    for (const char* c = next_; c != end_ && !is_rib_space(*c) && text.size() < 41; ++c) {
        text += static_cast<unsigned char>(*c) < 0x20 || *c == 0x7f ? '?' : *c;
    }
    return text + "'";
}

void RibRequestReader::error(const RibPlace& where, const std::string& message) {
    diagnostics_.error({file_, where.line, where.column}, message);
    ++errors_;
}

}  // namespace alhazen
