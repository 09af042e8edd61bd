#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "handles.h"

namespace alhazen::capi {

namespace {

struct ThreadErrors {
    std::vector<std::pair<std::uint64_t, AlhazenError>> first;  ///< by number of the device
    std::string text;
    bool telling = false;  ///< the error function of a device runs
};

ThreadErrors& errors_of_thread() {
    thread_local ThreadErrors errors;
    return errors;
}

AlhazenError code_of(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Usage:
        case ErrorKind::Scene:
            return ALHAZEN_ERROR_INVALID_ARGUMENT;
        case ErrorKind::Resource:
            return ALHAZEN_ERROR_OUT_OF_MEMORY;
        case ErrorKind::File:
        case ErrorKind::Render:
            break;
    }
    return ALHAZEN_ERROR_UNKNOWN;
}

std::pair<AlhazenError, std::string> current_error() {
    try {
        throw;
    } catch (const CodedError& error) {
        return {error.code(), error.what()};
    } catch (const Error& error) {
        return {code_of(error.kind()), error.what()};
    } catch (const std::bad_alloc&) {
        return {ALHAZEN_ERROR_OUT_OF_MEMORY, "out of memory"};
    } catch (const std::length_error&) {  // an array beyond all memory
        return {ALHAZEN_ERROR_OUT_OF_MEMORY, "out of memory"};
    } catch (const std::exception& error) {
        return {ALHAZEN_ERROR_UNKNOWN, error.what()};
    } catch (...) {
        return {ALHAZEN_ERROR_UNKNOWN, "unknown error"};
    }
}

/// Applies one "key=value" of a configuration.
void configure(Device& device, std::string_view key, std::string_view value) {
    constexpr std::string_view kIgnored[] = {
        "verbose",      "isa",       "max_isa",         "set_affinity", "start_threads",
        "user_threads", "hugepages", "frequency_level", "tri_accel"};
    if (key == "threads") {
        const std::string text(value);
        char* end = nullptr;
        const long threads = std::strtol(text.c_str(), &end, 10);
        need_argument(!text.empty() && *end == '\0' && threads >= 0 && threads <= 4096,
                      "threads: expected a number from 0 to 4096");
        device.threads = static_cast<int>(threads);
    } else if (key == "accelerator") {
        device.options.accelerator = value;
    } else if (key == "quality") {
        device.options.build.quality = find_build_quality(std::string(value));
    } else if (std::find(std::begin(kIgnored), std::end(kIgnored), key) == std::end(kIgnored)) {
        throw CodedError(
            ALHAZEN_ERROR_INVALID_ARGUMENT,
            "unknown key '" + std::string(key) + "'; known are threads, accelerator, quality");
    }
}

}  // namespace

void note_error(Device* device) noexcept {
    try {
        auto [code, text] = current_error();
        ThreadErrors& errors = errors_of_thread();
        const std::uint64_t number = device != nullptr ? device->number : 0;
        const auto known = std::find_if(errors.first.begin(), errors.first.end(),
                                        [&](const auto& e) { return e.first == number; });
        if (known == errors.first.end()) errors.first.emplace_back(number, code);
        errors.text = text;
        if (device == nullptr || device->error_function == nullptr || errors.telling) return;
        // The function may call the library; such errors are not reported and leave this text.
        errors.telling = true;
        try {
            device->error_function(device->error_pointer, code, text.c_str());
        } catch (...) {
            // Exceptions of an error function in C++ are ignored.
        }
        errors.telling = false;
        errors.text = std::move(text);
    } catch (...) {
        // No memory for the error itself.
    }
}

Device::Device(const char* config) {
    static std::atomic<std::uint64_t> devices{0};
    number = ++devices;
    std::string_view rest = config != nullptr ? config : "";
    while (!rest.empty()) {
        const std::string_view item = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(rest.size(), item.size() + 1));
        const std::size_t begin = item.find_first_not_of(" \t");
        if (begin == std::string_view::npos) continue;
        const std::string_view trimmed =
            item.substr(begin, item.find_last_not_of(" \t") - begin + 1);
        const std::size_t equals = trimmed.find('=');
        need_argument(equals != std::string_view::npos, "config: expected key=value,...");
        configure(*this, trimmed.substr(0, equals), trimmed.substr(equals + 1));
    }
    // Reports an unknown accelerator now, not when a scene is built.
    (void)Tracer(TracerScene(), options);
}

bool Device::tell_memory(std::int64_t bytes, bool post) const {
    return memory_function == nullptr ||
           memory_function(memory_pointer, static_cast<ssize_t>(bytes), post);
}

}  // namespace alhazen::capi

using namespace alhazen::capi;

AlhazenDevice alhazenNewDevice(const char* config) {
    return guarded(nullptr, static_cast<AlhazenDevice>(nullptr),
                   [&] { return reinterpret_cast<AlhazenDevice>(new Device(config)); });
}
void alhazenRetainDevice(AlhazenDevice device) {
    if (device != nullptr) object(device)->retain();
}
void alhazenReleaseDevice(AlhazenDevice device) {
    if (device != nullptr) object(device)->release();
}

AlhazenError alhazenGetDeviceError(AlhazenDevice device) {
    ThreadErrors& errors = errors_of_thread();
    const std::uint64_t number = device != nullptr ? object(device)->number : 0;
    const auto known = std::find_if(errors.first.begin(), errors.first.end(),
                                    [&](const auto& e) { return e.first == number; });
    if (known == errors.first.end()) return ALHAZEN_ERROR_NONE;
    const AlhazenError code = known->second;
    errors.first.erase(known);
    return code;
}
const char* alhazenGetDeviceErrorMessage(AlhazenDevice) {
    return errors_of_thread().text.c_str();
}
void alhazenSetDeviceErrorFunction(AlhazenDevice device, AlhazenErrorFunction error,
                                   void* userPtr) {
    guarded(object(device), [&] {
        need_argument(device != nullptr, "the device is NULL");
        object(device)->error_function = error;
        object(device)->error_pointer = userPtr;
    });
}
void alhazenSetDeviceMemoryMonitorFunction(AlhazenDevice device,
                                           AlhazenMemoryMonitorFunction monitor, void* userPtr) {
    guarded(object(device), [&] {
        need_argument(device != nullptr, "the device is NULL");
        object(device)->memory_function = monitor;
        object(device)->memory_pointer = userPtr;
    });
}

ssize_t alhazenGetDeviceProperty(AlhazenDevice, AlhazenDeviceProperty property) {
    switch (property) {
        case ALHAZEN_DEVICE_PROPERTY_VERSION:
            return 10000 * ALHAZEN_C_MAJOR + 100 * ALHAZEN_C_MINOR + ALHAZEN_C_PATCH;
        case ALHAZEN_DEVICE_PROPERTY_VERSION_MAJOR:
            return ALHAZEN_C_MAJOR;
        case ALHAZEN_DEVICE_PROPERTY_VERSION_MINOR:
            return ALHAZEN_C_MINOR;
        case ALHAZEN_DEVICE_PROPERTY_VERSION_PATCH:
            return ALHAZEN_C_PATCH;
        case ALHAZEN_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_RAY_MASK_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_IGNORE_INVALID_RAYS_ENABLED:
        case ALHAZEN_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_POINT_GEOMETRY_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_JOIN_COMMIT_SUPPORTED:
            return 1;
        case ALHAZEN_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED:
        case ALHAZEN_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_QUAD_GEOMETRY_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_SUBDIVISION_GEOMETRY_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_CURVE_GEOMETRY_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_USER_GEOMETRY_SUPPORTED:
        case ALHAZEN_DEVICE_PROPERTY_TASKING_SYSTEM:
        case ALHAZEN_DEVICE_PROPERTY_PARALLEL_COMMIT_SUPPORTED:
            break;
    }
    return 0;
}
