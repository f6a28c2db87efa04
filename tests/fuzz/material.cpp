// Fuzzes the readers of material files: tables, .lnk files of optool, and YAML.
#include "fuzz.hpp"
#include "scene/material_data.hpp"

void dolp::fuzz::read(const std::string& text) {
  static const InputFile csv(".csv"), lnk(".lnk"), yaml(".yml");
  for (const InputFile* file : {&csv, &lnk, &yaml}) {
    file->write(text);
    refused([&] { dolp::read_material_file(file->path(), {10.0, 10.0}, ""); });
  }
}
