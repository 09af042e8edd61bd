#include "alhazen/formats/bpt/bpt_reader.h"

#include <array>

#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/patches/patch_welder.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

constexpr int kMaxBptErrors = 50;
/// Largest degree for which a rejected patch is skipped by its number of points.
constexpr std::int64_t kMaxSkippedDegree = 1000;

/// Moves to the next number of this line; false at a comment or at its end.
bool to_bpt_value(TextCursor& cursor) {
    return cursor.skip_blanks() && cursor.peek() != '#';
}

/// Number of values in the rest of the line, at most 4; -1 if one of them is not a number.
int values_in_line(TextCursor cursor) {
    int count = 0;
    for (double value = 0; count < 4 && to_bpt_value(cursor); ++count) {
        if (!cursor.number(value)) return -1;
    }
    return count;
}

/// True if the line holds two integers and nothing else.
bool is_degree_line(TextCursor cursor) {
    std::int64_t value = 0;
    return values_in_line(cursor) == 2 && to_bpt_value(cursor) && cursor.integer(value) &&
           to_bpt_value(cursor) && cursor.integer(value);
}

class BptReader {
  public:
    BptReader(std::string_view bytes, const std::string& file, const ImportOptions& options,
              Diagnostics& diagnostics)
        : cursor_(bytes), file_(file), options_(options), diagnostics_(diagnostics) {}

    std::vector<BptMesh> read() {
        const bool counted = read_count();
        for (patch_ = 1; errors_ < kMaxBptErrors && cursor_.skip_to_word("#"); ++patch_) {
            if (counted && patch_ == count_ + 1) warn_of_more();
            read_patch();
        }
        if (errors_ >= kMaxBptErrors) {
            error("too many errors; the rest of the file is not read");
        } else if (counted && patch_ <= count_) {
            error("the file ends after " + std::to_string(patch_ - 1) + " of " +
                  std::to_string(count_) + " patches");
        }
        std::vector<BptMesh> meshes;
        if (errors_ != 0) return meshes;
        for (Group& group : groups_) meshes.push_back({group.welder.take(), group.location});
        return meshes;
    }

  private:
    struct Group {
        PatchWelder welder;
        FileLocation location;
    };

    bool read_count() {
        if (!cursor_.skip_to_word("#")) {
            error("the file has no patches");
            return false;
        }
        if (is_degree_line(cursor_)) {
            error("expected the number of patches before the first patch");
            return false;
        }
        const TextCursor start = cursor_;
        if (!cursor_.integer(count_) || count_ < 1) {
            cursor_ = start;
            error("expected the number of patches, found " + cursor_.shown_word());
            cursor_.skip_line();
            return false;
        }
        return true;
    }

    void warn_of_more() {
        diagnostics_.warning(cursor_.location(file_), "there are more patches than the " +
                                                          std::to_string(count_) +
                                                          " that the file announces; all are read");
    }

    void read_patch() {
        where_ = cursor_.location(file_);
        if (values_in_line(cursor_) == 3) {
            error("expected the two degrees of patch " + std::to_string(patch_) +
                  ", found a point: the patch before has more points than its degrees require");
            skip_to_degrees();
            return;
        }
        std::array<std::int64_t, 2> degrees{};
        bool good = true;
        for (std::size_t k = 0; k < 2; ++k) {
            if (!cursor_.skip_to_word("#") || !cursor_.integer(degrees[k])) {
                error("expected a degree of patch " + std::to_string(patch_) + ", found " +
                      cursor_.shown_word());
                skip_to_degrees();
                return;
            }
            if (degrees[k] >= 1 && degrees[k] <= kMaxPatchDegree) continue;
            error_at(where_, "patch " + std::to_string(patch_) + ": degrees are from 1 to " +
                                 std::to_string(kMaxPatchDegree) + ", not " +
                                 std::to_string(degrees[k]));
            good = false;
        }
        if (!good && (degrees[0] < 0 || degrees[1] < 0 || degrees[0] > kMaxSkippedDegree ||
                      degrees[1] > kMaxSkippedDegree)) {
            skip_to_degrees();
            return;
        }
        if (!read_points((degrees[0] + 1) * (degrees[1] + 1), good) || !good) return;
        group_of(std::uint32_t(degrees[0]), std::uint32_t(degrees[1])).welder.add(points_);
    }

    /// Reads the points of a patch. False after an error; the cursor is then where reading can
    /// continue.
    bool read_points(std::int64_t count, bool keep) {
        points_.clear();
        bool good = true;
        for (std::int64_t k = 0; k < count; ++k) {
            const bool more = cursor_.skip_to_word("#");
            if (!more || is_degree_line(cursor_)) {
                error("patch " + std::to_string(patch_) + " has " + std::to_string(k) +
                      " points; its degrees require " + std::to_string(count));
                return false;
            }
            Vec3 point;
            const bool read = read_point(point);
            good = good && read;
            if (errors_ >= kMaxBptErrors) return false;
            if (read && keep) points_.push_back(point);
        }
        points_read_ += std::uint64_t(count);
        if (points_read_ <= options_.max_elements) return good;
        throw Error(ErrorKind::Resource,
                    "more than " + std::to_string(options_.max_elements) + " control points",
                    cursor_.location(file_));
    }

    bool read_point(Vec3& point) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!to_bpt_value(cursor_)) {
                error("a point has three numbers, found " + std::to_string(axis));
                return false;
            }
            if (!cursor_.number(point[axis])) {
                error("expected a number, found " + cursor_.shown_word());
                cursor_.skip_line();
                return false;
            }
        }
        return true;
    }

    void skip_to_degrees() {
        while (cursor_.skip_to_word("#") && !is_degree_line(cursor_)) cursor_.skip_line();
        // If the file ends here, an error about the number of patches would be redundant.
        if (cursor_.at_end()) count_ = 0;
    }

    Group& group_of(std::uint32_t degree_u, std::uint32_t degree_v) {
        for (Group& group : groups_) {
            if (group.welder.takes(degree_u, degree_v)) return group;
        }
        groups_.push_back({PatchWelder(degree_u, degree_v), where_});
        return groups_.back();
    }

    void error(const std::string& message) { error_at(cursor_.location(file_), message); }
    void error_at(const FileLocation& where, const std::string& message) {
        diagnostics_.error(where, message);
        ++errors_;
    }

    TextCursor cursor_;
    const std::string& file_;
    const ImportOptions& options_;
    Diagnostics& diagnostics_;
    std::vector<Group> groups_;
    std::vector<Vec3> points_;
    FileLocation where_;
    std::int64_t count_ = 0, patch_ = 0;
    std::uint64_t points_read_ = 0;
    int errors_ = 0;
};

}  // namespace

bool looks_like_bpt(std::string_view bytes) {
    TextCursor cursor(bytes.substr(0, 65536));
    for (const int values : {1, 2, 3}) {
        if (!cursor.skip_to_word("#") || values_in_line(cursor) != values) return false;
        if (values == 2 && !is_degree_line(cursor)) return false;
        cursor.skip_line();
    }
    return true;
}

std::vector<BptMesh> read_bpt(std::string_view bytes, const std::string& file,
                              const ImportOptions& options, Diagnostics& diagnostics) {
    if (report_wide_text(bytes, file, diagnostics)) return {};
    return BptReader(bytes, file, options, diagnostics).read();
}

}  // namespace alhazen
