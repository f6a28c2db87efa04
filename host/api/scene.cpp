#include "api/scene_impl.hpp"
#include "api/translated.hpp"
#include "scene/scene_reader.hpp"
#include "scene/scene_writer.hpp"

namespace dolp::api {

Scene Scene::from_file(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return translated([&] { return Scene(std::make_shared<const Impl>(Impl{read_scene(path.string(), overrides)})); });
}

Scene Scene::from_text(const std::string& text, const std::vector<std::string>& overrides, const std::string& name) {
  return translated([&] { return Scene(std::make_shared<const Impl>(Impl{parse_scene(text, name, overrides)})); });
}

Scene Scene::with(const std::vector<std::string>& overrides) const {
  std::vector<std::string> all = this->overrides();
  all.insert(all.end(), overrides.begin(), overrides.end());
  return from_text(text(), all, name());
}

const std::string& Scene::title() const { return impl_->scene.title; }
const std::string& Scene::name() const { return impl_->scene.path_name; }
const std::string& Scene::text() const { return impl_->scene.text; }
const std::vector<std::string>& Scene::overrides() const { return impl_->scene.overrides; }

std::string Scene::toml() const {
  return translated([&] { return scene_toml(text(), name(), overrides(), std::filesystem::current_path()); });
}

std::vector<Key> keys() {
  std::vector<Key> all;
  for (const KeyDescription& key : scene_keys()) {
    all.push_back({key.key, key.unit, key.allowed(), key.fallback, key.meaning});
  }
  return all;
}

}  // namespace dolp::api
