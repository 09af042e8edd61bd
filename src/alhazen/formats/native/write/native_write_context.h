#pragma once
/// State that the functions of the native writer share while a scene is written.

#include <string>
#include <vector>

#include "alhazen/formats/core/default_conventions.h"
#include "alhazen/formats/native/fields/native_text.h"
#include "alhazen/formats/native/write/native_writer.h"

namespace alhazen {

struct NativeWriteContext {
    const SceneDescription& scene;
    const std::string& folder;
    const NativeFileSink& write_beside;
    std::string text = {};

    // Unique labels of the blocks, one for each material, texture, geometry and so on.
    std::vector<std::string> material_labels = {}, texture_labels = {}, geometry_labels = {},
                             object_labels = {};

    /// Writes a file of the folder and returns its name in the scene.
    std::string write_file(const std::string& file_name, std::span<const std::byte> bytes) const {
        return write_beside(folder + "/" + file_name, bytes);
    }
    void append(const NativeBlockText& block, int indent = 0) {
        text += block.text(indent);
        text += '\n';
    }
};

/// Adds the original name if the label differs from it.
inline void add_name(NativeBlockText& block, const std::string& label, const std::string& name) {
    if (label != name) block.add("name", native_string(name));
}

void write_native_picture(NativeWriteContext& context);
void write_native_environment(NativeWriteContext& context);
void write_native_conventions(NativeWriteContext& context);
void write_native_cameras(NativeWriteContext& context);
void write_native_lights(NativeWriteContext& context);
void write_native_textures(NativeWriteContext& context);
void write_native_materials(NativeWriteContext& context);
void write_native_geometries(NativeWriteContext& context);
void write_native_objects(NativeWriteContext& context);

}  // namespace alhazen
