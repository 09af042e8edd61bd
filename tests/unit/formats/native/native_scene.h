#pragma once
/// What the tests of the native format share: import from text, and the parts of the result.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>

#include "alhazen/base/file.h"
#include "alhazen/formats/native/read/native_importer.h"
#include "unit/formats/text_scene.h"

namespace alhazen::testing {

inline Imported import_native(const std::string& body, const ImportOptions& options = {}) {
    return import_text<NativeImporter>("alhazen 1\n" + body, "scene.alhazen", options);
}

inline Imported import_native_file(const std::filesystem::path& path,
                                   const ImportOptions& options = {}) {
    return import_text<NativeImporter>(read_file(path), path, options);
}

inline const Material& material_of(const Imported& i, std::size_t part) {
    return i.scene.materials.at(static_cast<std::size_t>(i.parts().at(part).material)).material;
}

template <class S>
const S& shape_of(const Imported& i, std::size_t part) {
    return std::get<S>(std::get<AnyShape>(i.parts().at(part).what));
}

inline void expect_near(const Vec3& a, const Vec3& b) {
    EXPECT_NEAR(a.x, b.x, 1e-12);
    EXPECT_NEAR(a.y, b.y, 1e-12);
    EXPECT_NEAR(a.z, b.z, 1e-12);
}

}  // namespace alhazen::testing
