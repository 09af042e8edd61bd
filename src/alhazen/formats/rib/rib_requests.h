#pragma once
/// The requests of a RIB file, read one after the other: a name, and arguments that are numbers,
/// strings or arrays of these.
///
/// Source: Pixar, "The RenderMan Interface", version 3.2, 2000, appendix C (RIB).
/// Differs: the binary encoding is rejected. Hints (`##`) are comments.
/// Conventions: numbers are finite. Lines and columns count from 1. The arguments of a request are
/// stored in arrays that the next request reuses.
/// Complexity: linear in time; memory for the largest request.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/diagnostics.h"

namespace alhazen {

struct RibPlace {
    int line = 0, column = 0;
};

struct RibArgument {
    enum class Kind : std::uint8_t { Number, String, Numbers, Strings };
    Kind kind = Kind::Number;
    RibPlace place;
    /// Range in the numbers or strings of the request, of length one for Number and String.
    std::size_t begin = 0, end = 0;
};

struct RibRequest {
    std::string_view name;
    RibPlace place;
    std::vector<RibArgument> arguments;
    std::vector<double> numbers;
    std::vector<std::string> strings;

    /// The number of an argument that is a number or an array of one; none for others.
    [[nodiscard]] std::optional<double> number(std::size_t argument) const;
    /// The string of an argument that is a string or an array of one; null for others.
    [[nodiscard]] const std::string* string(std::size_t argument) const;
    [[nodiscard]] std::size_t count(std::size_t argument) const {
        return arguments[argument].end - arguments[argument].begin;
    }
    /// The numbers of an argument; empty for strings.
    [[nodiscard]] std::span<const double> list(std::size_t argument) const;
    [[nodiscard]] bool is_numbers(std::size_t argument) const {
        return arguments[argument].kind == RibArgument::Kind::Numbers ||
               arguments[argument].kind == RibArgument::Kind::Number;
    }
};

class RibRequestReader {
  public:
    RibRequestReader(std::string_view text, const std::string& file, Diagnostics& diagnostics)
        : next_(text.data()),
          line_start_(next_),
          end_(next_ + text.size()),
          file_(file),
          diagnostics_(diagnostics) {}

    /// Reads the next request; false at the end of the file and after too many errors. Skips a
    /// request with an error.
    bool read(RibRequest& request);

    [[nodiscard]] RibPlace place() const;
    [[nodiscard]] int errors() const { return errors_; }

  private:
    void skip_space();
    std::string_view word();
    bool read_argument(RibRequest& request);
    bool read_array(RibRequest& request);
    bool read_number(RibRequest& request);
    bool read_string(RibRequest& request);
    [[nodiscard]] bool at_word() const;
    void error(const RibPlace& where, const std::string& message);
    [[nodiscard]] std::string shown() const;

    const char* next_;
    const char* line_start_;
    const char* end_;
    int line_ = 1;
    const std::string& file_;
    Diagnostics& diagnostics_;
    int errors_ = 0;
};

}  // namespace alhazen
