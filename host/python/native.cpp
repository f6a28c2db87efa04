// Python binding of the library: arrays and dictionaries in, arrays out; the public interface is in dolp/__init__.py.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <dolp/dolp.hpp>

#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Columns = std::map<std::string, Array>;

constexpr auto kSignalsEvery = std::chrono::milliseconds(50);

/// Calls `body(progress)` in another thread, while Python's other threads run, and ends it when a signal asks for that.
template <class Body>
auto interruptible(const Body& body) {
  std::atomic<bool> goes_on = true;
  const dolp::Progress progress = [&](std::size_t, std::size_t) { return goes_on.load(); };
  py::gil_scoped_release others_run;
  auto result = std::async(std::launch::async, [&] { return body(progress); });
  while (result.wait_for(kSignalsEvery) != std::future_status::ready) {
    const py::gil_scoped_acquire python;
    if (PyErr_CheckSignals() == 0) continue;
    py::error_already_set interrupt;
    goes_on = false;
    {
      const py::gil_scoped_release end_of_call;
      result.wait();
    }
    throw interrupt;  // NOLINT(misc-throw-by-value-catch-by-reference): it has to be made before the call has ended
  }
  return result.get();
}

/// A value of a key: None, bool, float, str, a list of floats or a dictionary of from, to, count and spacing.
dolp::Value value_of(const std::string& key, const py::handle& value) {
  if (value.is_none()) return {};
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::float_>(value)) return value.cast<double>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (!py::isinstance<py::dict>(value)) return value.cast<std::vector<double>>();
  const auto range = value.cast<std::map<std::string, py::object>>();
  for (const auto& [name, item] : range) {
    if (name == "from" || name == "to" || name == "count" || name == "spacing") continue;
    throw dolp::InputError(key + ": " + name + " is none of from, to, count, spacing");
  }
  if (!range.contains("from") || !range.contains("to") || !range.contains("count")) {
    throw dolp::InputError(key + ": a range needs from, to and count");
  }
  const auto spacing = range.find("spacing");
  const std::string word = spacing == range.end() ? "linear" : spacing->second.cast<std::string>();
  if (word != "linear" && word != "log") throw dolp::InputError(key + ".spacing: must be one of linear, log");
  return dolp::AxisRange{range.at("from").cast<double>(), range.at("to").cast<double>(),
                         range.at("count").cast<std::size_t>(), word == "log"};
}

std::vector<dolp::Setting> settings_of(const py::dict& values) {
  std::vector<dolp::Setting> settings;
  for (const auto& [key, value] : values) {
    const auto name = key.cast<std::string>();
    settings.push_back({name, value_of(name, value)});
  }
  return settings;
}

/// Views of arrays that outlive the result.
std::vector<dolp::Column> views(const Columns& columns) {
  std::vector<dolp::Column> all;
  for (const auto& [name, values] : columns) {
    all.push_back({name, {values.data(), static_cast<std::size_t>(values.size())}});
  }
  return all;
}

/// Low, high and perhaps a start of each key.
std::vector<dolp::FitRange> ranges_of(const std::map<std::string, std::vector<double>>& vary) {
  std::vector<dolp::FitRange> ranges;
  for (const auto& [key, ends] : vary) {
    if (ends.size() < 2 || ends.size() > 3)
      throw dolp::InputError(key + ": must vary over (low, high) or (low, high, start)");
    ranges.push_back({key, ends[0], ends[1], ends.size() == 3 ? std::optional(ends[2]) : std::nullopt});
  }
  return ranges;
}

/// An array that owns `values`.
template <class Value>
py::array_t<Value> array_of(std::vector<Value> values) {
  auto* const own = new std::vector<Value>(std::move(values));
  const py::capsule owner(own, [](void* held) { delete static_cast<std::vector<Value>*>(held); });
  return py::array_t<Value>(own->size(), own->data(), owner);
}

/// (quantities: [(name, long_name, units, ancillary, values)], status, attributes).
py::tuple parts_of(dolp::Results results) {
  py::list quantities;
  for (const dolp::Quantity quantity : results.given) {
    const dolp::QuantityDescription& known = dolp::description_of(quantity);
    quantities.append(py::make_tuple(known.name, known.long_name, dolp::units_of(quantity, results.stokes_units),
                                     known.ancillary, array_of(std::move(results[quantity]))));
  }
  py::dict attributes;
  for (const auto& [name, value] : results.attributes) attributes[py::str(name)] = value;
  return py::make_tuple(quantities, array_of(std::move(results.status)), attributes);
}

py::dict description(const dolp::Device& device) {
  using py::literals::operator""_a;
  return py::dict("name"_a = device.name, "type"_a = dolp::type_name(device.type), "driver"_a = device.driver,
                  "api_version"_a = device.api_version, "usable"_a = device.usable, "why_not"_a = device.why_not,
                  "has_double"_a = device.has_double, "memory_bytes"_a = device.memory_bytes);
}

}  // namespace

PYBIND11_MODULE(_native, module) {
  py::register_exception<dolp::InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<dolp::DeviceError>(module, "DeviceError", PyExc_RuntimeError);
  py::register_exception<dolp::IoError>(module, "IoError", PyExc_OSError);

  py::register_exception<dolp::MemoryError>(module, "MemoryError", PyExc_MemoryError);

  py::class_<dolp::Scene>(module, "Scene")
      .def_static("from_file", [](const std::filesystem::path& path,
                                  const py::dict& values) { return dolp::Scene::from_file(path, settings_of(values)); })
      .def_static("from_text",
                  [](const std::string& text, const py::dict& values) {
                    return dolp::Scene::from_text(text, settings_of(values), "text");
                  })
      .def("with_", [](const dolp::Scene& scene, const py::dict& values) { return scene.with(settings_of(values)); })
      .def("toml", [](const dolp::Scene& scene) { return scene.toml(); })
      .def_property_readonly("title", &dolp::Scene::title);

  py::class_<dolp::Table>(module, "Table")
      .def_static("read", &dolp::Table::read)
      .def("lookup", [](const dolp::Table& table, const Columns& columns) {
        const std::vector<dolp::Column> points = views(columns);
        return parts_of(interruptible([&](const dolp::Progress& progress) { return table.lookup(points, progress); }));
      });

  py::class_<dolp::Evaluator>(module, "Evaluator")
      .def(py::init([](const std::string& evaluator, const std::string& device) {
        return dolp::Evaluator({evaluator, device});
      }))
      .def("write_table",
           [](dolp::Evaluator& evaluator, const dolp::Scene& scene, const std::filesystem::path& path, bool keep_all,
              bool resume) {
             return interruptible([&](const dolp::Progress& progress) {
               return evaluator.write_table(scene, path, {keep_all, progress, "dolp.table", resume}).text;
             });
           })
      .def("evaluate",
           [](dolp::Evaluator& evaluator, const dolp::Scene& scene, const Columns& columns, bool keep_all) {
             const std::vector<dolp::Column> points = views(columns);
             return parts_of(interruptible([&](const dolp::Progress& progress) {
               return evaluator.evaluate(scene, points, {keep_all, progress, "dolp.evaluate"});
             }));
           })
      .def("fit",
           [](dolp::Evaluator& evaluator, const dolp::Scene& scene,
              const std::vector<std::pair<std::string, py::dict>>& data,
              const std::map<std::string, std::vector<double>>& vary, std::size_t starts, std::uint64_t seed) {
             std::vector<dolp::MeasuredData> sets;
             for (const auto& [csv, values] : data) {
               const std::string name = "data" + (data.size() > 1 ? std::to_string(sets.size() + 1) : "");
               sets.push_back(dolp::MeasuredData::from_csv(csv, name, settings_of(values)));
             }
             dolp::FitOptions options{.vary = ranges_of(vary), .starts = starts, .seed = seed};
             dolp::Fit fit = interruptible([&](const dolp::Progress& progress) {
               options.progress = progress;
               return evaluator.fit(scene, sets, options);
             });
             if (!fit.has_minimum) {
               throw dolp::InputError("fit: no descent converged; try other ranges, or more starts");
             }
             return py::make_tuple(fit.report.text, fit.report.json, std::move(fit.scene));
           })
      .def("mueller", [](dolp::Evaluator& evaluator, const dolp::Scene& scene, const Columns& columns) {
        const std::vector<dolp::Column> points = views(columns);
        const std::vector<dolp::MuellerMatrix> matrices = interruptible(
            [&](const dolp::Progress& progress) { return evaluator.mueller(scene, points, {.progress = progress}); });
        py::array_t<double> result({matrices.size(), std::size_t{4}, std::size_t{4}});
        double* to = result.mutable_data();
        for (const dolp::MuellerMatrix& matrix : matrices) to = std::copy(matrix.begin(), matrix.end(), to);
        return result;
      });

  module.def("plan", [](const dolp::Scene& scene, const std::string& device, bool keep_all) {
    const dolp::Report plan = dolp::plan(scene, device, keep_all);
    return py::make_tuple(plan.text, plan.json);
  });
  module.def("devices", [] {
    py::list all;
    for (const dolp::Device& device : dolp::devices()) all.append(description(device));
    return all;
  });
  module.def("materials", [] {
    py::list all;
    for (const dolp::BuiltInMaterial& material : dolp::materials()) {
      all.append(py::make_tuple(material.name, material.from_um, material.to_um, material.source));
    }
    return all;
  });
  module.def("keys", [] {
    py::list all;
    for (const dolp::Key& key : dolp::keys()) {
      all.append(py::make_tuple(key.key, key.unit, key.allowed(), key.fallback, key.meaning));
    }
    return all;
  });
  module.def("axes", [] {
    py::list all;
    for (const dolp::Axis axis : dolp::kColumnOrder) {
      const dolp::AxisDescription& known = dolp::description_of(axis);
      all.append(py::make_tuple(known.column, known.name, known.long_name, known.units));
    }
    return all;
  });
  module.def("status_bits", [] {
    py::list all;
    for (const dolp::StatusBit& bit : dolp::kStatusBits) all.append(py::make_tuple(bit.mask, bit.meaning));
    return all;
  });
  module.def("version", &dolp::version);
  module.def("commit", &dolp::commit);
  module.def("citation", &dolp::citation);
}
