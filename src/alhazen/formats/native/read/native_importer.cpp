#include "alhazen/formats/native/read/native_importer.h"

#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/core/default_conventions.h"
#include "alhazen/formats/native/read/native_cameras.h"
#include "alhazen/formats/native/read/native_include.h"
#include "alhazen/formats/native/read/native_objects.h"
#include "alhazen/formats/native/read/native_parts.h"
#include "alhazen/formats/native/read/native_settings.h"

namespace alhazen {

const char* NativeImporter::description() const {
    return "Alhazen's own scene text (.alhazen), docs/reference/formats/native.md";
}

int NativeImporter::recognise(const ImportSource& source) const {
    constexpr std::size_t kLook = 65536;  // comments may precede the header
    const SourceText text(source.bytes.substr(0, kLook), "");
    Diagnostics ignored;
    Lexer lexer(text, ignored);
    const Token word = lexer.next();
    const Token version = lexer.next();
    if (word.kind == TokenKind::Word && word.text == "alhazen" &&
        version.kind == TokenKind::Number) {
        return 2;
    }
    return source.path.extension() == ".alhazen" ? 1 : 0;
}

SceneDescription NativeImporter::import(const ImportSource& source,
                                        Diagnostics& diagnostics) const {
    SceneDescription scene;
    scene.format = name();
    scene.path = source.path;
    scene.conventions = default_conventions();
    scene.objects.push_back({"scene", {}, {source.path.string(), 1, 1}});
    if (report_wide_text(source.bytes, source.path.string(), diagnostics)) return scene;
    const SourceText text(source.bytes, source.path.string());
    const TextTree tree(text,
                        {.max_nesting = source.options.max_nesting,
                         .max_nodes = source.options.max_elements,
                         .string_escapes = true},
                        diagnostics);
    if (!check_native_header(tree.root(), text.location(0), diagnostics)) return scene;
    NativeContext context(scene, diagnostics, source.options);
    context.open_files.push_back(file_identity(std::filesystem::absolute(source.path)));
    std::vector<Part> parts;
    NativeScope scope{parts, {}, std::nullopt, folder_of(source.path)};
    read_native_items(tree.root(), context, scope, 1);
    scene.objects[static_cast<std::size_t>(scene.root)].parts = std::move(parts);
    check_listed_objects(context);
    complete_cameras(context);
    open_shutter(scene, scene.shutter);
    return scene;
}

}  // namespace alhazen
