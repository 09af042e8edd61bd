#include "alhazen/formats/native/read/native_include.h"

#include <algorithm>

#include "alhazen/base/file.h"
#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/native/read/native_parts.h"

namespace alhazen {

namespace {

/// Limit that stops a chain of small files each of which includes the next one twice.
constexpr std::uint64_t kMaxIncludedFiles = 10'000;

/// Throws Error (Resource) if one more file would exceed the limits.
void check_limits(const NativeContext& context, const FileLocation& where) {
    if (context.open_files.size() > static_cast<std::size_t>(context.options.max_include_depth)) {
        throw Error(ErrorKind::Resource,
                    "files include each other more than " +
                        std::to_string(context.options.max_include_depth) + " deep",
                    where);
    }
    if (context.included_files >= kMaxIncludedFiles) {
        throw Error(ErrorKind::Resource,
                    "more than " + std::to_string(kMaxIncludedFiles) + " included files", where);
    }
}

/// The bytes of the file; none if it is unreadable or already being read.
std::optional<std::string> read_bytes(TextNode name, NativeContext& context,
                                      const NativeScope& scope, std::filesystem::path& path) {
    const FileLocation where = name.location();
    check_limits(context, where);
    try {
        path = resolve_inside(context.roots, scope.folder, std::string(name.text()));
        if (std::find(context.open_files.begin(), context.open_files.end(), file_identity(path)) !=
            context.open_files.end()) {
            context.diagnostics.error(where, "include: the file includes itself");
            return std::nullopt;
        }
        context.diagnostics.note_file(path);
        std::string bytes =
            read_file(path, context.options.max_included_bytes - context.included_bytes);
        context.included_bytes += bytes.size();
        ++context.included_files;
        return bytes;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Resource) throw;
        context.diagnostics.error(where, std::string("include: ") + error.what());
        return std::nullopt;
    }
}

}  // namespace

std::filesystem::path file_identity(const std::filesystem::path& path) {
    std::error_code failed;
    std::filesystem::path real = std::filesystem::weakly_canonical(path, failed);
    return failed ? path : real;
}

bool check_native_header(TextNode root, const FileLocation& start, Diagnostics& diagnostics) {
    constexpr double kVersion = 1;
    if (root.empty() || !root.first().is(NodeKind::Entry, "alhazen") || root.first().empty() ||
        !root.first().first().is(NodeKind::Number)) {
        diagnostics.error(start, "expected the header 'alhazen 1' at the start of the file");
        return false;
    }
    if (root.first().first().number() == kVersion) return true;
    diagnostics.error(root.first().first().location(),
                      "this version of the format is not known; expected 'alhazen 1'");
    return false;
}

void read_native_include(TextNode entry, NativeContext& context, NativeScope& scope) {
    if (entry.empty() || !entry.first().is(NodeKind::String) || entry.size() != 1) {
        context.diagnostics.error(entry.location(), "include: expected include \"FILE\";");
        return;
    }
    std::filesystem::path path;
    const std::optional<std::string> bytes = read_bytes(entry.first(), context, scope, path);
    if (!bytes) return;
    if (report_wide_text(*bytes, path.string(), context.diagnostics)) return;
    const SourceText text(without_byte_order_mark(*bytes), path.string());
    const TextTree tree(text,
                        {.max_nesting = context.options.max_nesting,
                         .max_nodes = context.options.max_elements,
                         .string_escapes = true},
                        context.diagnostics);
    if (!check_native_header(tree.root(), text.location(0), context.diagnostics)) return;
    context.open_files.push_back(file_identity(path));
    NativeScope inner = scope;
    inner.folder = path.parent_path();
    read_native_items(tree.root(), context, inner, 1);
    scope.material = inner.material;
    context.open_files.pop_back();
}

}  // namespace alhazen
