#pragma once
/// Objects, transforms and groups of the SBT-raytracer format.
///
/// Source: docs/reference/formats/ray.md.
/// Differs: `material = ...` inside a group works (the grammar has it; the course program fails on
/// it).
/// Conventions: transforms are multiplied out; the scene becomes one flat object.

#include "alhazen/formats/ray/ray_context.h"
#include "alhazen/formats/ray/ray_materials.h"
#include "alhazen/formats/text/text_tree.h"

namespace alhazen {

class RayObjects {
  public:
    RayObjects(RayContext& context, RayMaterials& materials)
        : context_(context), materials_(materials) {}

    /// Reads one item of the file other than a camera or light: an object, a transform, a group or
    /// a material. `material` is the default, which the item may change.
    void read(TextNode item, RayMaterial& material) { read(item, {}, material, Place::TopLevel); }

  private:
    /// Where an item stands; cameras and lights are items of the top level only.
    enum class Place { TopLevel, Inside };

    void read(TextNode item, const Affine& object_from_part, RayMaterial& material, Place place);
    void read_group(TextNode block, const Affine& object_from_part, RayMaterial material);
    /// Multiplies `object_from_part` by the transform; returns the operand of the transform.
    std::optional<TextNode> read_transform(TextNode entry, Affine& object_from_part);
    void read_untransformed(TextNode item, const Affine& object_from_part, RayMaterial& material,
                            Place place);
    void read_shape(TextNode entry, const Affine& object_from_part, const RayMaterial& material);
    void refuse(TextNode item, Place place);
    /// The items valid at a place, for messages.
    [[nodiscard]] static std::string known(Place place);

    RayContext& context_;
    RayMaterials& materials_;
    bool refused_word_ = false;        ///< the last item was a word alone, and refused
    bool after_refused_word_ = false;  ///< so was the item before the one that is read
};

}  // namespace alhazen
