#include "handles.h"

namespace alhazen::capi {

Memory::Memory(Device* owner, std::size_t size) : device(owner), bytes(size) {
    constexpr std::size_t kPadding = 16;  // the last float3 may be read and written as 16 bytes
    need(size <= own_.max_size() - kPadding, ALHAZEN_ERROR_OUT_OF_MEMORY,
         "the buffer is too large");
    own_.resize(size + kPadding);
    begin = own_.data();
}

}  // namespace alhazen::capi

using namespace alhazen::capi;

AlhazenBuffer alhazenNewBuffer(AlhazenDevice device, size_t byteSize) {
    return guarded(object(device), static_cast<AlhazenBuffer>(nullptr), [&] {
        need_argument(device != nullptr, "the device is NULL");
        return reinterpret_cast<AlhazenBuffer>(new Memory(object(device), byteSize));
    });
}
AlhazenBuffer alhazenNewSharedBuffer(AlhazenDevice device, void* ptr, size_t byteSize) {
    return guarded(object(device), static_cast<AlhazenBuffer>(nullptr), [&] {
        need_argument(device != nullptr, "the device is NULL");
        need_argument(ptr != nullptr || byteSize == 0, "the memory of a buffer is NULL");
        return reinterpret_cast<AlhazenBuffer>(new Memory(object(device), ptr, byteSize));
    });
}
void* alhazenGetBufferData(AlhazenBuffer buffer) {
    return buffer != nullptr ? object(buffer)->begin : nullptr;
}
void alhazenRetainBuffer(AlhazenBuffer buffer) {
    if (buffer != nullptr) object(buffer)->retain();
}
void alhazenReleaseBuffer(AlhazenBuffer buffer) {
    if (buffer != nullptr) object(buffer)->release();
}
