#pragma once
/// Layers of a film in addition to its colours: named channels with one number per pixel.
///
/// Conventions: those of `Film`; a channel is named "layer.component", as in multi-layer EXR files.
/// Threads: different pixels may be `set` at the same time.

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/imaging/film/film.h"

namespace alhazen {

enum class SampleType { Half, Float, Uint };

struct LayerChannel {
    std::string name;
    SampleType type = SampleType::Float;
    std::vector<float> values = {};         ///< [crop height][crop width]; for Half and Float
    std::vector<std::uint32_t> whole = {};  ///< [crop height][crop width]; for Uint
};

class FilmLayers {
  public:
    FilmLayers() = default;
    /// All values are 0. `crop`: that of the film.
    explicit FilmLayers(const PixelBox& crop) : crop_(crop) {}

    /// Adds a channel and returns its index.
    std::size_t add(std::string name, SampleType type) {
        LayerChannel& channel = channels_.emplace_back();
        channel.name = std::move(name);
        channel.type = type;
        if (type == SampleType::Uint) {
            channel.whole.resize(crop_.area());
        } else {
            channel.values.resize(crop_.area());
        }
        return channels_.size() - 1;
    }

    void set(std::size_t channel, int x, int y, double value) {
        channels_[channel].values[index(x, y)] = static_cast<float>(value);
    }
    void set_whole(std::size_t channel, int x, int y, std::uint32_t value) {
        channels_[channel].whole[index(x, y)] = value;
    }

    [[nodiscard]] const PixelBox& crop() const { return crop_; }
    [[nodiscard]] const std::vector<LayerChannel>& channels() const { return channels_; }
    /// The channel of a name, or null.
    [[nodiscard]] const LayerChannel* find(const std::string& name) const {
        for (const LayerChannel& channel : channels_) {
            if (channel.name == name) return &channel;
        }
        return nullptr;
    }

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return std::size_t(y - crop_.y0) * std::size_t(crop_.width()) + std::size_t(x - crop_.x0);
    }

    PixelBox crop_;
    std::vector<LayerChannel> channels_;
};

}  // namespace alhazen
