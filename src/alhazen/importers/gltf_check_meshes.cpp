// stub for now
#include "alhazen/importers/gltf_readers.h"
namespace alhazen::gltf {
void check_meshes(const Loading&) {}
void check_skins_and_animations(const Loading&) {}
void check_data(const Loading&) {}
}  // namespace alhazen::gltf
