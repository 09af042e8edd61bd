// Checks that each accessor has one use, and each buffer view one kind of content.
#include <algorithm>

#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

enum class Use : std::uint8_t { None, Vertices, Indices, BindMatrices, Times, Values, Image };

const char* described(Use use) {
    switch (use) {
        case Use::None:
            return "nothing";
        case Use::Vertices:
            return "vertex attributes";
        case Use::Indices:
            return "indices";
        case Use::BindMatrices:
            return "inverse bind matrices";
        case Use::Times:
            return "times of animations";
        case Use::Values:
            return "values of animations";
        case Use::Image:
            return "an image";
    }
    return "";
}

/// The content that a use implies: times and values of animations may lie in one view.
Use content_of(Use use) {
    return use == Use::Times ? Use::Values : use;
}

constexpr Index kNobody = ~Index{0};

class UsageChecker {
  public:
    explicit UsageChecker(const Loading& loading)
        : loading_(loading),
          document_(loading.document),
          accessors_(document_.accessors.size(), Use::None),
          views_(document_.views.size(), Use::None),
          vertex_accessors_(document_.views.size(), kNobody),
          reported_(document_.views.size(), false) {
        for (std::size_t i = 0; i < views_.size(); ++i) {
            if (document_.views[i].target == kVertexTarget) views_[i] = Use::Vertices;
            if (document_.views[i].target == kIndexTarget) views_[i] = Use::Indices;
        }
    }

    void run() {
        for (std::size_t i = 0; i < document_.meshes.size(); ++i) {
            for (std::size_t j = 0; j < document_.meshes[i].primitives.size(); ++j) {
                primitive(document_.meshes[i].primitives[j],
                          pointer_to("meshes", i, "primitives", j));
            }
        }
        for (std::size_t i = 0; i < document_.skins.size(); ++i) {
            const auto& matrices = document_.skins[i].inverse_bind_matrices;
            if (matrices) use(*matrices, Use::BindMatrices, [&] { return pointer_to("skins", i); });
        }
        for (std::size_t i = 0; i < document_.animations.size(); ++i) {
            const auto& samplers = document_.animations[i].samplers;
            for (std::size_t j = 0; j < samplers.size(); ++j) {
                const auto place = [&] { return pointer_to("animations", i, "samplers", j); };
                use(samplers[j].input, Use::Times, place);
                use(samplers[j].output, Use::Values, place);
            }
        }
        for (std::size_t i = 0; i < document_.images.size(); ++i) {
            const auto& view = document_.images[i].view;
            if (view) use_view(*view, Use::Image, [&] { return pointer_to("images", i); });
        }
        for (std::size_t i = 0; i < document_.accessors.size(); ++i) sparse(i);
    }

  private:
    static constexpr std::uint32_t kVertexTarget = 34962, kIndexTarget = 34963;

    void primitive(const Primitive& primitive, const std::string& where) {
        const auto place = [&] { return where; };
        for (const auto& [name, index] : primitive.attributes) vertices(index, place);
        for (const Attributes& target : primitive.targets) {
            for (const auto& [name, index] : target) vertices(index, place);
        }
        if (primitive.indices) use(*primitive.indices, Use::Indices, place);
    }

    template <class Place>
    void vertices(Index index, const Place& place) {
        use(index, Use::Vertices, place);
        const auto view = document_.accessors[index].view;
        if (!view || document_.views[*view].stride != 0) return;
        Index& other = vertex_accessors_[*view];
        if (other != kNobody && other != index && !reported_[*view]) {
            reported_[*view] = true;
            loading_.error(pointer_to("bufferViews", *view), "accessors " + std::to_string(other) +
                                                                 " and " + std::to_string(index) +
                                                                 " of vertices need a byteStride");
        }
        other = index;
    }

    template <class Place>
    void use(Index index, Use use, const Place& place) {
        Use& known = accessors_[index];
        if (known == use) return;
        if (known != Use::None) {
            loading_.error(place(), "accessor " + std::to_string(index) + " is used for " +
                                        described(known) + " and for " + described(use));
            return;
        }
        known = use;
        const auto view = document_.accessors[index].view;
        if (!view) return;
        use_view(*view, content_of(use), place);
        const bool packed = use != Use::Vertices && use != Use::Indices;
        if (packed && document_.views[*view].stride != 0) {
            loading_.error(place(), std::string("the buffer view of ") + described(use) +
                                        " must not have a stride");
        }
    }

    template <class Place>
    void use_view(Index index, Use use, const Place& place) {
        Use& known = views_[index];
        if (known != use && known != Use::None) {
            loading_.error(place(), "buffer view " + std::to_string(index) + " is for " +
                                        described(known) + " and used for " + described(use));
            return;
        }
        known = use;
    }

    void sparse(std::size_t position) const {
        const auto& sparse = document_.accessors[position].sparse;
        if (!sparse) return;
        for (const Index view : {sparse->indices_view, sparse->values_view}) {
            if (document_.views[view].target == 0) continue;
            loading_.error(pointer_to("accessors", position) + "/sparse",
                           "buffer view " + std::to_string(view) + " must not have a target");
        }
    }

    const Loading& loading_;
    const Document& document_;
    std::vector<Use> accessors_, views_;
    std::vector<Index> vertex_accessors_;  ///< [view] the last accessor that uses the view
    std::vector<bool> reported_;           ///< [view] the missing stride has been reported
};

}  // namespace

void check_usage(const Loading& loading) {
    UsageChecker(loading).run();
}

}  // namespace alhazen::gltf
