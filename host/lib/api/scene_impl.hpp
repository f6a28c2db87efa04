// Implementation of the public scene.
#pragma once

#include <dolp/dolp.hpp>

#include "scene/scene.hpp"

namespace dolp {

struct Scene::Impl {
  SceneValues scene;
};

}  // namespace dolp
