// Python binding of the library, with arrays and dictionaries as arguments and results. Users call dolp/__init__.py.
#include <netcdf.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <dolp/dolp.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <map>
#include <ranges>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace py = pybind11;

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Columns = std::map<std::string, Array>;

constexpr auto kSignalsEvery = std::chrono::milliseconds(50);

/// Calls `body(progress)` in another thread. Other Python threads can run meanwhile, and Ctrl-C cancels the call.
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
    throw interrupt;  // the exception that Python raised for the signal, such as KeyboardInterrupt
  }
  return result.get();
}

constexpr const char* kOtherBytes = "surrogateescape";  // Python's way to keep bytes that are not UTF-8 in a str

py::str to_str(const std::string& text) {
  PyObject* const decoded = PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), kOtherBytes);
  if (!decoded) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

std::string to_utf8(const py::handle& text) {
  PyObject* const encoded = PyUnicode_AsEncodedString(text.ptr(), "utf-8", kOtherBytes);
  if (!encoded) {
    const py::error_already_set error;
    if (!error.matches(PyExc_UnicodeEncodeError)) throw error;
    const auto escaped = py::reinterpret_steal<py::str>(PyObject_ASCII(text.ptr()));
    throw dolp::InputError(escaped.cast<std::string>().substr(0, 60) +
                           ": holds a surrogate without its other half, which is no character");
  }
  return py::reinterpret_steal<py::bytes>(encoded);
}

void raise(const char* type, const std::exception& error) {
  const py::object raised = py::module_::import("dolp._native").attr(type);
  PyErr_SetObject(raised.ptr(), to_str(error.what()).ptr());
}

void translate(std::exception_ptr error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const dolp::InputError& input) {
    raise("InputError", input);
  } catch (const dolp::DeviceError& device) {
    raise("DeviceError", device);
  } catch (const dolp::IoError& io) {
    raise("IoError", io);
  } catch (const dolp::MemoryError& memory) {
    PyErr_SetObject(PyExc_MemoryError, to_str(memory.what()).ptr());
  }
}

void add_error(py::module_& module, const std::string& name, PyObject* base, const char* meaning) {
  PyObject* const type = PyErr_NewExceptionWithDoc(("dolp." + name).c_str(), meaning, base, nullptr);
  if (!type) throw py::error_already_set();
  module.attr(name.c_str()) = py::reinterpret_steal<py::object>(type);
}

std::size_t word_position(const std::string& argument, const std::string& word, const std::vector<std::string>& words) {
  const auto found = std::ranges::find(words, word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  std::string allowed;
  for (const std::string& one : words) allowed += (allowed.empty() ? "" : ", ") + one;
  throw dolp::InputError(argument + " = " + word + ": must be one of " + allowed);
}

/// Converts a value from Python: None, bool, float, str, a list, or a dictionary with from, to, count and spacing.
dolp::Value to_value(const std::string& key, const py::handle& value) {
  if (value.is_none()) return {};
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::float_>(value)) return value.cast<double>();
  if (py::isinstance<py::str>(value)) return to_utf8(value);
  if (py::isinstance<py::list>(value) && py::len(value) > 0 && !py::isinstance<py::float_>(value[py::int_(0)]))
    return dolp::TomlText{to_utf8(py::module_::import("json").attr("dumps")(value))};  // a JSON list is valid TOML
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

using Values = std::vector<std::pair<py::str, py::object>>;  // keys of a scene, each with its value as a Python object

std::vector<dolp::Setting> to_settings(const Values& values) {
  std::vector<dolp::Setting> settings;
  for (const auto& [key, value] : values) {
    const std::string name = to_utf8(key);
    settings.push_back({name, to_value(name, value)});
  }
  return settings;
}

/// Converts a value to a Python object; the reverse of to_value(). TOML text becomes a str.
py::object to_object(const dolp::Value& value) {
  const auto object = [](const auto& content) -> py::object {
    using Content = std::decay_t<decltype(content)>;
    if constexpr (std::is_same_v<Content, std::monostate>) {
      return py::none();
    } else if constexpr (std::is_same_v<Content, std::string>) {
      return to_str(content);
    } else if constexpr (std::is_same_v<Content, dolp::TomlText>) {
      return to_str(content.text);
    } else if constexpr (std::is_same_v<Content, dolp::AxisRange>) {
      using py::literals::operator""_a;
      return py::dict("from"_a = content.from, "to"_a = content.to, "count"_a = content.count,
                      "spacing"_a = content.is_logarithmic ? "log" : "linear");
    } else {
      return py::cast(content);
    }
  };
  return std::visit(object, value.content());
}

/// Issues each remark as a Python warning at the user's line. Throws if a Python filter makes the warning an error.
void warn(const std::vector<std::string>& remarks) {
  const py::object category = py::module_::import("dolp._native").attr("InputWarning");
  for (const std::string& remark : remarks)
    py::module_::import("dolp._arguments").attr("warn")(to_str(remark), category);
}

dolp::Scene with_warnings(dolp::Scene scene) {
  warn(scene.remarks());
  return scene;
}

py::object value_of_key(const dolp::Scene& scene, const std::string& key) {
  const auto object = [](const auto& value) -> py::object { return value ? py::cast(*value) : py::none(); };
  const auto known = std::ranges::find(dolp::keys(), key, &dolp::Key::key);
  const auto type = known == dolp::keys().end() ? dolp::Key::Type::kNumber : known->type;
  if (type == dolp::Key::Type::kNumber) return object(scene.number(key));
  if (type == dolp::Key::Type::kNames) {
    const std::vector<std::string>& names = scene.labels()[dolp::Axis::kMaterial];
    return names.empty() ? py::none() : py::object(py::cast(names));
  }
  if (type == dolp::Key::Type::kAxis || type == dolp::Key::Type::kPair || type == dolp::Key::Type::kPairs) {
    const std::vector<double> values = scene.numbers(key);
    return values.empty() ? py::none() : py::object(py::cast(values));
  }
  const std::optional<std::string> word = scene.word(key);
  if (!word || type != dolp::Key::Type::kFlag) return word ? py::object(to_str(*word)) : py::none();
  return py::bool_(*word == "true");
}

Values to_values(const std::vector<dolp::Setting>& settings) {
  Values values;
  for (const dolp::Setting& setting : settings) values.emplace_back(to_str(setting.key), to_object(setting.value));
  return values;
}

/// Columns that view the data of NumPy arrays. The arrays must outlive the columns.
std::vector<dolp::Column> views(const Columns& columns) {
  std::vector<dolp::Column> all;
  for (const auto& [name, values] : columns) {
    all.push_back({name, {values.data(), static_cast<std::size_t>(values.size())}});
  }
  return all;
}

std::vector<dolp::FitRange> to_ranges(const std::vector<std::pair<std::string, std::vector<double>>>& vary) {
  std::vector<dolp::FitRange> ranges;
  for (const auto& [key, ends] : vary) {
    if (ends.size() < 2 || ends.size() > 3)
      throw dolp::InputError(key + ": must vary over (low, high) or (low, high, start)");
    ranges.push_back({key, ends[0], ends[1], ends.size() == 3 ? std::optional(ends[2]) : std::nullopt});
  }
  return ranges;
}

template <class Range, class Of>
py::list to_list(Range&& range, const Of& of) {
  py::list all;
  for (const auto& element : range) all.append(of(element));
  return all;
}

template <class Value>
py::array_t<Value> to_array(std::vector<Value> values) {
  auto* const kept = new std::vector<Value>(std::move(values));
  const py::capsule owner(kept, [](void* held) { delete static_cast<std::vector<Value>*>(held); });
  return py::array_t<Value>(kept->size(), kept->data(), owner);
}

py::dict to_dict(const std::vector<dolp::Attribute>& attributes) {
  py::dict named;
  for (const auto& [name, value] : attributes) {
    if (const auto* number = std::get_if<double>(&value)) named[to_str(name)] = *number;
    if (const auto* text = std::get_if<std::string>(&value)) named[to_str(name)] = to_str(*text);
  }
  return named;
}

/// Makes the tuple that _native.pyi calls Parts.
py::tuple result_parts(dolp::ResultColumns results, const dolp::Quantities& given, const std::string& stokes_units,
                       const std::vector<dolp::Attribute>& attributes) {
  py::list quantities;
  for (const dolp::Quantity quantity : given) {
    const dolp::QuantityDescription& known = dolp::describe(quantity);
    quantities.append(py::make_tuple(known.name, known.long_name, to_str(dolp::quantity_units(quantity, stokes_units)),
                                     known.ancillary, to_array(std::move(results[quantity]))));
  }
  for (dolp::DerivativeColumn& column : results.derivatives)
    quantities.append(
        py::make_tuple(column.name, column.long_name, column.units, "", to_array(std::move(column.values))));
  return py::make_tuple(quantities, to_array(std::move(results.status)), to_dict(attributes));
}

py::tuple result_parts(dolp::Results results) {
  return result_parts(std::move(static_cast<dolp::ResultColumns&>(results)), results.given, results.stokes_units,
                      results.attributes);
}

/// Makes the tuple that _native.pyi calls Contents.
py::tuple table_contents(const dolp::Table& table) {
  const dolp::TableValues& values = table.values();
  py::list axes, curves;
  for (const dolp::Axis axis : dolp::kAllAxes) {
    const char* const name = dolp::describe(axis).name;
    if (!values.labels[axis].empty()) {
      const auto label = [&](double value) { return to_str(values.label(axis, value)); };
      axes.append(py::make_tuple(name, to_list(values.axes[axis], label)));
    } else if (!values.axes[axis].empty()) {
      axes.append(py::make_tuple(name, to_array(values.axes[axis])));
    }
  }
  for (const dolp::TableCurve& known : dolp::kTableCurves) {
    const std::vector<double>& used = (values.*known.curve).used;
    if (!used.empty()) curves.append(py::make_tuple(known.name, known.long_name, known.units, to_array(used)));
  }
  return py::make_tuple(axes, to_array(values.wind_m_s), curves,
                        result_parts(values, values.quantities(), values.stokes_units, table.file_attributes()));
}

/// Makes the second element of the tuple that Evaluator.response() returns; _native.pyi describes it.
py::tuple response_tuple(const dolp::TableValues& table) {
  py::list variables;
  for (const dolp::ResponseVariable variable : dolp::kAllResponseVariables) {
    const dolp::ResponseDescription& known = dolp::describe(variable);
    if (table.responses[variable].empty()) continue;
    variables.append(py::make_tuple(known.name, known.long_name, known.has_beta ? dolp::kResponseQualifier : "",
                                    known.has_beta, to_array(table.responses[variable])));
  }
  return py::make_tuple(to_array(table.beta_deg), dolp::kBeta.long_name, dolp::kBeta.units, variables);
}

/// Maps the column names of materials and bands to their lists of labels. A column has positions in its list of labels.
py::dict to_label_lists(const dolp::AxisLabels& labels) {
  py::dict all;
  for (const dolp::Axis axis : dolp::kAllAxes) {
    if (!dolp::describe(axis).has_labels) continue;
    all[dolp::describe(axis).column] = to_list(labels[axis], to_str);
  }
  return all;
}

std::vector<dolp::Attribute> to_attributes(const py::dict& attributes) {
  std::vector<dolp::Attribute> all;
  for (const auto& [name, value] : attributes) {
    if (py::isinstance<py::str>(value)) {
      all.push_back({to_utf8(name), to_utf8(value)});
    } else {
      all.push_back({to_utf8(name), value.cast<double>()});
    }
  }
  return all;
}

}  // namespace

PYBIND11_MODULE(_native, module) {
  // HDF5 prints errors, except in the thread that starts it. xarray handles errors in this thread.
  nc_initialize();
  add_error(module, "InputError", PyExc_ValueError, "A scene, points, a table or an argument is wrong.");
  add_error(module, "DeviceError", PyExc_RuntimeError, "There is no usable Vulkan device, or it was lost.");
  add_error(module, "IoError", PyExc_OSError, "A file could not be read or written.");
  add_error(module, "InputWarning", PyExc_UserWarning,
            "Input is accepted but was probably meant otherwise, or lacks data that the scene assumes.");
  py::register_exception_translator(translate);

  const auto from_text = [](const py::str& text, const Values& values, const py::str& name) {
    return dolp::Scene::from_text(to_utf8(text), to_settings(values), to_utf8(name));
  };
  py::class_<dolp::Scene>(module, "Scene")
      .def_static("from_file",
                  [](const std::filesystem::path& path, const Values& values) {
                    return with_warnings(dolp::Scene::from_file(path, to_settings(values)));
                  })
      .def_static("from_text",
                  [from_text](const py::str& text, const Values& values, const py::str& name) {
                    return with_warnings(from_text(text, values, name));
                  })
      .def("with_", [](const dolp::Scene& scene,
                       const Values& values) { return with_warnings(scene.with(to_settings(values))); })
      .def_static("from_attributes",
                  [](const py::dict& attributes, const py::str& name) {
                    return with_warnings(dolp::Scene::from_attributes(to_attributes(attributes), to_utf8(name)));
                  })
      .def("for_points", &dolp::Scene::for_points)
      .def("toml", [](const dolp::Scene& scene) { return to_str(scene.toml()); })
      .def("values", [](const dolp::Scene& scene) { return to_values(scene.settings()); })
      .def("value", [](const dolp::Scene& scene, const py::str& key) { return value_of_key(scene, to_utf8(key)); })
      .def("model_advice", &dolp::Scene::model_advice)
      .def("labels", [](const dolp::Scene& scene) { return to_label_lists(scene.labels()); })
      .def("refractive_index", &dolp::Scene::refractive_index)
      .def("__deepcopy__", [](const dolp::Scene& scene, const py::dict&) { return scene; })
      .def(py::pickle(
          [](const dolp::Scene& scene) {
            const auto line = [](const dolp::Setting& setting) { return to_str(setting.text()); };
            const bool is_of_table = !scene.table_attributes().empty();
            return py::make_tuple(
                to_str(scene.text()),
                is_of_table ? py::object(to_list(scene.settings(), line)) : py::cast(to_values(scene.settings())),
                to_str(scene.name()), to_dict(scene.table_attributes()));
          },
          [from_text](const py::tuple& state) {
            const auto attributes = state[3].cast<py::dict>();
            if (attributes.empty()) return from_text(state[0], state[1].cast<Values>(), state[2]);
            std::vector<std::string> settings;
            for (const py::handle& line : state[1]) settings.push_back(to_utf8(line));
            return dolp::Scene::from_attributes(to_attributes(attributes), to_utf8(state[2]))
                .with_all(dolp::settings_from_text(settings));
          }))
      .def_property_readonly("evaluator", &dolp::Scene::evaluator)
      .def_property_readonly("is_of_table", [](const dolp::Scene& scene) { return !scene.table_attributes().empty(); })
      .def_property_readonly("name", [](const dolp::Scene& scene) { return to_str(scene.name()); })
      .def_property_readonly("title", [](const dolp::Scene& scene) { return to_str(scene.title()); });

  py::class_<dolp::Evaluator>(module, "Evaluator")
      .def(py::init([](const std::string& evaluator, const std::string& device) {
        return dolp::Evaluator({evaluator, device});
      }))
      .def("table",
           [](dolp::Evaluator& evaluator, const dolp::Scene& scene, bool keep_all, std::vector<std::string> quantities,
              std::vector<std::string> derivatives) {
             return table_contents(interruptible([&](const dolp::Progress& progress) {
               return evaluator.table(
                   scene, {keep_all, progress, "dolp.table", false, std::move(quantities), std::move(derivatives)});
             }));
           })
      .def("response",
           [](dolp::Evaluator& evaluator, const dolp::Scene& scene) {
             const dolp::Table table = interruptible([&](const dolp::Progress& progress) {
               return evaluator.response(scene, {.progress = progress, .history = "dolp.response"});
             });
             return py::make_tuple(table_contents(table), response_tuple(table.values()));
           })
      .def("write_table",
           [](dolp::Evaluator& evaluator, const dolp::Scene& scene, const std::filesystem::path& path, bool keep_all,
              bool resume, std::vector<std::string> quantities, std::vector<std::string> derivatives) {
             return to_str(interruptible([&](const dolp::Progress& progress) {
               const dolp::RunOptions options{
                   keep_all, progress, "dolp.table", resume, std::move(quantities), std::move(derivatives)};
               return evaluator.write_table(scene, path, options).text;
             }));
           })
      .def("evaluate",
           [](dolp::Evaluator& evaluator, const dolp::Scene& scene, const Columns& columns, bool keep_all,
              std::vector<std::string> derivatives) {
             const std::vector<dolp::Column> points = views(columns);
             dolp::Results results = interruptible([&](const dolp::Progress& progress) {
               return evaluator.evaluate(scene, points,
                                         {.keep_all = keep_all,
                                          .progress = progress,
                                          .history = "dolp.evaluate",
                                          .derivatives = std::move(derivatives)});
             });
             warn(results.remarks);
             return result_parts(std::move(results));
           })
      .def("fit",
           [](dolp::Evaluator& evaluator, const dolp::Scene& scene,
              const std::vector<std::pair<std::string, Values>>& data,
              const std::vector<std::pair<std::string, std::vector<double>>>& vary,
              const std::vector<std::pair<std::string, std::vector<std::string>>>& compare, const std::string& loss,
              const std::string& model_error, std::size_t starts, std::uint64_t seed,
              const std::filesystem::path& plot) {
             std::vector<dolp::MeasuredData> sets;
             for (const auto& [csv, values] : data) {
               const std::string name = "data" + (data.size() > 1 ? std::to_string(sets.size() + 1) : "");
               sets.push_back(dolp::MeasuredData::from_csv(csv, name, to_settings(values)));
               warn(sets.back().remarks);
             }
             dolp::FitOptions options{.vary = to_ranges(vary), .starts = starts, .seed = seed, .plot = plot};
             for (const auto& [key, words] : compare) options.compare.push_back({key, words});
             options.loss = static_cast<dolp::Loss>(word_position("loss", loss, dolp::loss_names()));
             options.model_error =
                 static_cast<dolp::ModelError>(word_position("model_error", model_error, dolp::model_error_names()));
             dolp::Fit fit = interruptible([&](const dolp::Progress& progress) {
               options.progress = progress;
               return evaluator.fit(scene, sets, options);
             });
             if (!fit.has_minimum) {
               throw dolp::InputError("fit: no descent converged; try other ranges, or more starts");
             }
             return py::make_tuple(to_str(fit.report.text), to_str(fit.report.json), std::move(fit.scene));
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
    return py::make_tuple(to_str(plan.text), to_str(plan.json));
  });
  module.def("devices", [] {
    using py::literals::operator""_a;
    return to_list(dolp::devices(), [](const dolp::Device& device) {
      return py::dict("name"_a = device.name, "type"_a = dolp::type_name(device.type), "driver"_a = device.driver,
                      "api_version"_a = device.api_version, "usable"_a = device.usable, "why_not"_a = device.why_not,
                      "has_double"_a = device.has_double, "memory_bytes"_a = device.memory_bytes);
    });
  });
  const auto material_facts = [](const dolp::BuiltInMaterial& material) {
    return py::make_tuple(material.name, material.from_um, material.to_um, material.source, material.kind);
  };
  module.def("materials", [=] { return to_list(dolp::materials(), material_facts); });
  module.def("material", [=](const py::str& name) { return material_facts(dolp::material(to_utf8(name))); });
  module.def("keys", [] {
    const auto is_first = [](const dolp::Key& key) { return key.layer <= 1; };  // each further film has the same keys
    return to_list(dolp::keys() | std::views::filter(is_first), [](const dolp::Key& key) {
      return py::make_tuple(key.key, key.unit, key.allowed(), key.fallback, key.meaning);
    });
  });
  module.def("key_by_meaning", [](const py::str& unknown) -> py::object {
    const std::optional<dolp::KeyHint> meant = dolp::key_by_meaning(to_utf8(unknown));
    return meant ? py::object(to_str(meant->key)) : py::none();
  });
  module.def("axes", [] {
    const auto described = [](const dolp::AxisDescription& axis) {
      return py::make_tuple(axis.column, axis.name, axis.long_name, axis.units);
    };
    py::list all = to_list(dolp::kColumnOrder, [&](dolp::Axis axis) { return described(dolp::describe(axis)); });
    all.append(described(dolp::kWind));
    return all;
  });
  module.def("status_bits", [] {
    return to_list(dolp::kStatusBits, [](const dolp::StatusBit& bit) { return py::make_tuple(bit.mask, bit.meaning); });
  });
  module.def("surface_settings", [] { return to_values(dolp::surface_settings()); });
  module.def("response_fingerprints", [](const Array& entries) {
    std::vector<double> found;
    const std::size_t width = static_cast<std::size_t>(entries.shape(1));
    for (py::ssize_t i = 0; i < entries.shape(0); ++i)
      found.push_back(dolp::response_fingerprint({entries.data(i, 0), width}));
    return to_array(std::move(found));
  });
  module.def("version", &dolp::version);
  module.def("citation", &dolp::citation);
}
