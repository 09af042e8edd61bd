#pragma once
/// Words of the native format for enumerators, shared by its reader and its writer.

#include "alhazen/formats/text/block_reader.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// All words of one enumeration. ADD A WORD HERE: a specialisation, or a line of one.
template <class Enum>
[[nodiscard]] const Vocabulary<Enum>& native_words();

template <>
inline const Vocabulary<EnvironmentKind>& native_words() {
    using E = EnvironmentKind;
    static const Vocabulary<E> kWords{
        {"constant", E::Constant}, {"picture", E::Picture}, {"sky", E::Sky}, {"studio", E::Studio}};
    return kWords;
}
template <>
inline const Vocabulary<SolidTexture::Kind>& native_words() {
    using E = SolidTexture::Kind;
    static const Vocabulary<E> kWords{{"checks", E::Checks},
                                      {"stripes", E::Stripes},
                                      {"noise", E::Noise},
                                      {"marble", E::Marble},
                                      {"wood", E::Wood}};
    return kWords;
}
template <>
inline const Vocabulary<WideProjection>& native_words() {
    using E = WideProjection;
    static const Vocabulary<E> kWords{
        {"equidistant", E::Equidistant}, {"equisolid", E::Equisolid}, {"panorama", E::Panorama}};
    return kWords;
}
template <>
inline const Vocabulary<ShadingConventions::Highlight>& native_words() {
    using E = ShadingConventions::Highlight;
    static const Vocabulary<E> kWords{
        {"phong", E::Phong}, {"blinn_phong", E::BlinnPhong}, {"schlick", E::Schlick}};
    return kWords;
}
template <>
inline const Vocabulary<ShadingConventions::ShadowTint>& native_words() {
    using E = ShadingConventions::ShadowTint;
    static const Vocabulary<E> kWords{{"per_crossing", E::PerCrossing},
                                      {"per_distance", E::PerDistance},
                                      {"opaque", E::Opaque},
                                      {"none", E::None}};
    return kWords;
}
template <>
inline const Vocabulary<ShadingConventions::RefractionTint>& native_words() {
    using E = ShadingConventions::RefractionTint;
    static const Vocabulary<E> kWords{{"per_event", E::PerEvent}, {"per_distance", E::PerDistance}};
    return kWords;
}
template <>
inline const Vocabulary<ShadingConventions::AmbientFactor>& native_words() {
    using E = ShadingConventions::AmbientFactor;
    static const Vocabulary<E> kWords{{"ambient", E::Ambient}, {"diffuse", E::Diffuse}};
    return kWords;
}
template <>
inline const Vocabulary<SamplingConventions::PixelSample>& native_words() {
    using E = SamplingConventions::PixelSample;
    static const Vocabulary<E> kWords{{"center", E::Center},
                                      {"lower_left_corner", E::LowerLeftCorner},
                                      {"frame_corners", E::FrameCorners}};
    return kWords;
}
template <>
inline const Vocabulary<Combine>& native_words() {
    static const Vocabulary<Combine> kWords{{"group", Combine::Group},
                                            {"union", Combine::Union},
                                            {"intersection", Combine::Intersection},
                                            {"difference", Combine::Difference}};
    return kWords;
}
template <>
inline const Vocabulary<CutMaterial>& native_words() {
    static const Vocabulary<CutMaterial> kWords{{"own", CutMaterial::Own},
                                                {"minuend", CutMaterial::Minuend}};
    return kWords;
}
template <>
inline const Vocabulary<UpAxis>& native_words() {
    static const Vocabulary<UpAxis> kWords{{"y", UpAxis::Y}, {"z", UpAxis::Z}};
    return kWords;
}
template <>
inline const Vocabulary<Channel>& native_words() {
    static const Vocabulary<Channel> kWords{{"mean", Channel::Mean},
                                            {"red", Channel::Red},
                                            {"green", Channel::Green},
                                            {"blue", Channel::Blue},
                                            {"alpha", Channel::Alpha}};
    return kWords;
}
template <>
inline const Vocabulary<AlphaMode>& native_words() {
    static const Vocabulary<AlphaMode> kWords{
        {"opaque", AlphaMode::Opaque}, {"mask", AlphaMode::Mask}, {"blend", AlphaMode::Blend}};
    return kWords;
}
template <>
inline const Vocabulary<IlluminantKind>& native_words() {
    // A black body has its own word.
    static const Vocabulary<IlluminantKind> kWords{
        {"A", IlluminantKind::A}, {"D65", IlluminantKind::D65}, {"E", IlluminantKind::E}};
    return kWords;
}
template <>
inline const Vocabulary<Wrap>& native_words() {
    static const Vocabulary<Wrap> kWords{
        {"repeat", Wrap::Repeat}, {"clamp", Wrap::Clamp}, {"mirror", Wrap::Mirror}};
    return kWords;
}
template <>
inline const Vocabulary<TextureFilter>& native_words() {
    static const Vocabulary<TextureFilter> kWords{
        {"nearest", TextureFilter::Nearest},
        {"bilinear", TextureFilter::Bilinear},
        {"mipmapped", TextureFilter::Mipmapped},
        {"nearest_mipmapped", TextureFilter::NearestMipmapped}};
    return kWords;
}

/// The word of an enumerator.
template <class Enum>
[[nodiscard]] std::string_view native_word(Enum value) {
    for (const auto& [word, meaning] : native_words<Enum>()) {
        if (meaning == value) return word;
    }
    return {};
}

}  // namespace alhazen
