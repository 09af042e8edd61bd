// Readers of buffers and buffer views.
#include <map>

#include "alhazen/base/file.h"
#include "alhazen/formats/gltf/document/gltf_readers.h"
#include "alhazen/formats/gltf/document/gltf_uri.h"

namespace alhazen::gltf {

namespace {

using SharedBytes = std::shared_ptr<const std::string>;

/// Loads the data of the buffers, each file once.
class BufferLoader {
  public:
    BufferLoader(const Loading& loading, std::vector<bool> used)
        : loading_(loading), used_(std::move(used)) {}

    Buffer load(const JsonObject& object, std::size_t position) {
        Buffer buffer;
        (void)object.text("name");
        object.require("byteLength");
        const auto length = object.integer("byteLength", 1);
        if (!length) return buffer;
        buffer.length = *length;
        if (object.has("uri")) {
            buffer.owned = named(object, position);
            if (buffer.owned) buffer.bytes = *buffer.owned;
        } else if (position == 0 && loading_.binary) {
            buffer.bytes = *loading_.binary;
            // The chunk is padded to a multiple of 4 bytes.
            if (buffer.bytes.size() >= *length + 4) {
                object.warning({}, "the binary chunk is larger than the buffer");
            }
        } else {
            buffer.lacks_data = true;
            if (position == 0 && loading_.is_glb) {
                object.error({}, "the buffer has no uri and the file no binary chunk");
            } else if (used_[position]) {
                object.warning({}, "the buffer has no data; numbers in it are taken as 0");
            }
            return buffer;
        }
        if (buffer.bytes.size() >= *length) {
            buffer.bytes = buffer.bytes.substr(0, *length);
        } else if (buffer.owned || !object.has("uri")) {
            object.error("byteLength", "expected " + std::to_string(*length) + " bytes, found " +
                                           std::to_string(buffer.bytes.size()));
        }
        return buffer;
    }

  private:
    /// The bytes of the member "uri"; null after an error or if the buffer is unused.
    SharedBytes named(const JsonObject& object, std::size_t position) {
        const auto uri = object.take_text("uri");
        if (!uri) return nullptr;
        if (is_data_uri(*uri)) {
            auto data = read_data_uri(*uri);
            if (!data) {
                object.error("uri", "malformed data: URI");
                return nullptr;
            }
            if (data->media_type != "application/octet-stream" &&
                data->media_type != "application/gltf-buffer") {
                object.error("uri",
                             "the media type of a data: URI must be application/octet-stream or "
                             "application/gltf-buffer, found \"" +
                                 data->media_type.substr(0, 80) + '"');
            }
            return std::make_shared<const std::string>(std::move(data->bytes));
        }
        if (is_absolute_uri(*uri) && !used_[position]) {
            object.warning("uri", "not relative to the file; the buffer is not used");
            return nullptr;
        }
        const auto name = percent_decoded(*uri);
        if (name) return file(object, *name);
        object.error("uri", "malformed: % must be followed by two hexadecimal digits");
        return nullptr;
    }

    SharedBytes file(const JsonObject& object, const std::string& name) {
        try {
            const auto path = resolve_inside(loading_.roots, loading_.folder, name);
            SharedBytes& bytes = files_[path];
            if (!bytes) {
                loading_.diagnostics.note_file(path);
                const std::uint64_t limit = loading_.source.options.max_included_bytes;
                bytes = std::make_shared<const std::string>(read_file(path, limit - included_));
                included_ += bytes->size();
            }
            return bytes;
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::Resource) throw;
            object.error("uri", error.what());
            return nullptr;
        }
    }

    const Loading& loading_;
    std::vector<bool> used_;
    std::map<std::filesystem::path, SharedBytes> files_;
    std::uint64_t included_ = 0;
};

BufferView read_view(const JsonObject& object) {
    BufferView view;
    (void)object.text("name");
    object.require("buffer");
    object.require("byteLength");
    view.buffer = object.index("buffer", Collection::Buffers).value_or(0);
    view.offset = object.integer("byteOffset").value_or(0);
    view.length = object.integer("byteLength", 1).value_or(0);
    view.stride = static_cast<std::uint32_t>(object.integer("byteStride", 4, 252).value_or(0));
    if (view.stride % 4 != 0) object.error("byteStride", "expected a multiple of 4");
    if (view.stride > view.length) {
        object.error("byteStride", "the stride is larger than the buffer view");
    }
    if (const auto target = object.integer("target"); target) {
        if (*target != 34962 && *target != 34963) {
            object.warning("target", "expected 34962 or 34963; ignored");
        } else {
            view.target = static_cast<std::uint32_t>(*target);
        }
        if (*target == 34963 && view.stride != 0) {
            object.error("byteStride", "a buffer view of indices must not have a stride");
        }
    }
    return view;
}

}  // namespace

void read_buffers(const JsonObject& root, Loading& loading) {
    std::vector<bool> used(loading.size_of(Collection::Buffers), false);
    root.each_object("bufferViews", [&](const JsonObject& object, std::size_t) {
        loading.document.views.push_back(read_view(object));
        const Index buffer = loading.document.views.back().buffer;
        if (buffer < used.size()) used[buffer] = true;
    });
    BufferLoader loader(loading, std::move(used));
    root.each_object("buffers", [&](const JsonObject& object, std::size_t position) {
        loading.document.buffers.push_back(loader.load(object, position));
    });
}

std::string_view bytes_of(const Document& document, const BufferView& view) {
    return document.buffers[view.buffer].bytes.substr(view.offset, view.length);
}

}  // namespace alhazen::gltf
