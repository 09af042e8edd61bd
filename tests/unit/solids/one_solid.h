#pragma once
/// A solid given as text of the native format, for the tests of measures.

#include <string>

#include "alhazen/solids/isolated_solid.h"
#include "support/scene_maker.h"
#include "unit/formats/native/native_scene.h"

namespace alhazen::testing {

/// The solid of a scene without other objects.
class OneSolid {
  public:
    explicit OneSolid(const std::string& text)
        : solids_(compile(import_native(text).scene, {.accelerator = "list"}).aggregate),
          solid(solids_, SolidId{0}) {}

  private:
    SolidList solids_;

  public:
    IsolatedSolid solid;
};

}  // namespace alhazen::testing
