// What a public scene holds.
#pragma once

#include <dolp/dolp.hpp>

#include "scene/scene.hpp"

namespace dolp::api {

struct Scene::Impl {
  dolp::Scene scene;
};

}  // namespace dolp::api
