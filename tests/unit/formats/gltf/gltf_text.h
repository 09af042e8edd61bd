#pragma once
/// Small glTF files for tests: JSON with data URIs.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include "alhazen/formats/gltf/scene/gltf_importer.h"
#include "unit/formats/text_scene.h"

namespace alhazen::testing {

/// Little-endian bytes of these numbers (the byte order of all supported machines).
template <class T>
std::string bytes_of_numbers(std::initializer_list<double> numbers) {
    std::string bytes;
    for (const double number : numbers) {
        const T value = static_cast<T>(number);
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof(T));
        bytes.append(raw, sizeof(T));
    }
    return bytes;
}

inline std::string base64(const std::string& bytes) {
    static constexpr char kLetters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group =
                group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            const bool padding = i + k > bytes.size();
            text += padding ? '=' : kLetters[group >> (18 - 6 * k) & 63u];
        }
    }
    return text;
}

/// Collects accessors, each with a buffer and view of its own.
class GltfText {
  public:
    /// Adds an accessor of `type` ("VEC3") over floats and returns its index. Scalars, which may be
    /// times, get bounds unless `more` is given.
    int floats(const std::string& type, std::initializer_list<double> numbers,
               const std::string& more = "") {
        const bool bounded = type == "SCALAR" && more.empty();
        return add(5126, 4, type, bytes_of_numbers<float>(numbers), numbers.size(),
                   bounded ? scalar_bounds(numbers) : more);
    }
    int bytes(const std::string& type, std::initializer_list<double> numbers,
              const std::string& more = "") {
        return add(5121, 1, type, bytes_of_numbers<unsigned char>(numbers), numbers.size(), more);
    }
    int signed_bytes(const std::string& type, std::initializer_list<double> numbers,
                     const std::string& more = "") {
        return add(5120, 1, type, bytes_of_numbers<signed char>(numbers), numbers.size(), more);
    }
    int shorts(const std::string& type, std::initializer_list<double> numbers,
               const std::string& more = "") {
        return add(5123, 2, type, bytes_of_numbers<unsigned short>(numbers), numbers.size(), more);
    }

    /// The file; `rest` are its other members ("\"nodes\": ..., \"meshes\": ...").
    [[nodiscard]] std::string file(const std::string& rest) const {
        std::string text = R"({"asset": {"version": "2.0"}, )" + rest;
        if (!accessors_.empty()) {
            text += R"(, "accessors": [)" + accessors_ + R"(], "bufferViews": [)" + views_ +
                    R"(], "buffers": [)" + buffers_ + "]";
        }
        return text + "}";
    }

  private:
    static std::string scalar_bounds(std::initializer_list<double> numbers) {
        const auto text = [](double number) {
            char digits[32];
            std::snprintf(digits, sizeof(digits), "%.9g", number);
            return std::string(digits);
        };
        return R"(, "min": [)" + text(std::min(numbers)) + R"(], "max": [)" +
               text(std::max(numbers)) + "]";
    }

    int add(int component, std::size_t size, const std::string& type, const std::string& data,
            std::size_t numbers, const std::string& more) {
        const std::size_t width = type == "SCALAR" ? 1
                                  : type == "VEC2" ? 2
                                  : type == "VEC3" ? 3
                                  : type == "MAT4" ? 16
                                                   : 4;
        const char* comma = accessors_.empty() ? "" : ", ";
        const std::string n = std::to_string(count_);
        // Vertex attributes must start at multiples of four bytes: pads narrow elements.
        std::string padded;
        const std::size_t element = width * size, stride = (element + 3) / 4 * 4;
        for (std::size_t i = 0; i < data.size(); i += element) {
            padded += data.substr(i, element) + std::string(stride - element, '\0');
        }
        const bool strided = stride != element && type != "SCALAR";
        const std::string& kept = strided ? padded : data;
        accessors_ += comma + (R"({"bufferView": )" + n) + R"(, "componentType": )" +
                      std::to_string(component) + R"(, "count": )" +
                      std::to_string(numbers / width) + R"(, "type": ")" + type + '"' + more + "}";
        views_ += comma + (R"({"buffer": )" + n) + R"(, "byteLength": )" +
                  std::to_string(kept.size()) +
                  (strided ? R"(, "byteStride": )" + std::to_string(stride) : "") + "}";
        buffers_ += comma + (R"({"byteLength": )" + std::to_string(kept.size())) +
                    R"(, "uri": "data:application/octet-stream;base64,)" + base64(kept) + R"("})";
        return count_++;
    }

    std::string accessors_, views_, buffers_;
    int count_ = 0;
};

inline Imported import_gltf(const std::string& text, const ImportOptions& options = {}) {
    return import_text<GltfImporter>(text, "scene.gltf", options);
}

/// `"POSITION": n` with the required bounds of a position accessor.
inline std::string bounds(const std::string& lo, const std::string& hi) {
    return R"(, "min": [)" + lo + R"(], "max": [)" + hi + "]";
}

/// World-space positions of a part of the root object's object.
inline std::vector<Vec3> world_positions(const SceneDescription& scene, std::size_t part = 0) {
    const Part& outer = scene.objects.at(0).parts.at(part);
    const Part& inner =
        scene.objects.at(std::size_t(std::get<ObjectIndex>(outer.what))).parts.at(0);
    std::vector<Vec3> points;
    for (const Vec3& p :
         scene.meshes.at(std::size_t(std::get<MeshIndex>(inner.what))).mesh->positions) {
        points.push_back((outer.object_from_part * inner.object_from_part).point(p));
    }
    return points;
}

#define EXPECT_NEAR_VEC(expected, actual, bound)                \
    do {                                                        \
        const alhazen::Vec3 want_ = (expected), is_ = (actual); \
        EXPECT_NEAR(want_.x, is_.x, bound);                     \
        EXPECT_NEAR(want_.y, is_.y, bound);                     \
        EXPECT_NEAR(want_.z, is_.z, bound);                     \
    } while (false)

}  // namespace alhazen::testing
