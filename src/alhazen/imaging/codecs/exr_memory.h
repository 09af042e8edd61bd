#pragma once
/// An output stream in memory for the OpenEXR library.

#include <ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace alhazen {

class ExrMemoryOutput final : public Imf::OStream {
  public:
    ExrMemoryOutput() : Imf::OStream("memory") {}

    void write(const char source[], int count) override {
        const std::size_t end = position_ + std::size_t(count);
        if (bytes_.size() < end) bytes_.resize(end);
        std::memcpy(bytes_.data() + position_, source, std::size_t(count));
        position_ = end;
    }
    void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = std::size_t(position); }
    std::vector<std::byte> take() { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
    std::size_t position_ = 0;
};

}  // namespace alhazen
