// What a public scene holds.
#pragma once

#include <dolp/dolp.hpp>

#include "scene/scene.hpp"

namespace dolp {

struct Scene::Impl {
  SceneValues scene;
};

}  // namespace dolp
