#include "explore/window/actions.hpp"

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "base/python_picture.hpp"
#include "base/stopwatch.hpp"
#include "explore/readout.hpp"

namespace dolp::explore {
namespace {

constexpr auto kFading = std::chrono::milliseconds(300);  // a closed dialog fades for so long

}  // namespace

Actions::Actions(Session& session, const std::string& device, std::string command_line,
                 const std::filesystem::path& preferences, const std::function<void()>& on_change)
    : session_(session),
      command_line_(std::move(command_line)),
      table_evaluator_({.device = device, .is_interactive = true}),
      fit_evaluator_({.device = device, .is_interactive = true}),
      table_(on_change),
      true_error_(on_change),
      fit_(on_change),
      plot_(on_change) {
  try {
    preferences_.load(preferences);
    const std::string file = session_.scene().name();
    std::error_code unknown;
    if (!std::filesystem::exists(file, unknown)) return;  // a built-in text
    prefer([&](Preferences& kept) { kept.remember(file); });
  } catch (const std::exception& error) {
    session_.tell(error.what(), true);
  }
}

void Actions::attempt(const std::string& done, const std::function<void()>& body) {
  try {
    body();
    session_.tell(done);
  } catch (const std::exception& error) {
    session_.tell(error.what(), true);
  }
}

void Actions::open(const std::string& path) {
  attempt("opened " + path, [&] {
    open_file(session_, path);
    if (session_.message().is_error) throw InputError(session_.message().text);
    prefer([&](Preferences& preferences) { preferences.remember(path); });
  });
}

void Actions::prefer(const std::function<void(Preferences&)>& change) {
  change(preferences_);
  preferences_.save();
}

void Actions::save_picture(const std::string& path) {
  check_writable(path);
  picture_path_ = path;
  picture_time_ = Clock::now() + kFading;
}

void Actions::save_plot(const std::string& path, const Scale& x, const Scale& y) {
  session_.tell("drawing " + path);
  plot_.start([path, json = plot_json(session_, x, y)](const Progress&) -> BackgroundTask::Ending {
    check_writable(path);
    draw_with_python(kPlotScript, json, path);
    return [text = "saved " + path] { return text; };
  });
}

void Actions::export_table(const std::string& path) {
  table_.start([this, path, scene = session_.scene()](const Progress& progress) -> BackgroundTask::Ending {
    const Clock::time_point start = Clock::now();
    table_evaluator_.write_table(scene, path, {.progress = progress, .history = command_line_});
    return [text = fmt::format("{}: written in {:.2f} s", path, seconds_since(start))] { return text; };
  });
}

void Actions::find_true_error() {
  if (!session_.curve().is_finished()) return;
  true_error_key_ = session_.curve().key();
  true_error_.start([curve = session_.curve()](const Progress& progress) -> BackgroundTask::Ending {
    return [text = true_error(curve, progress)] { return text; };
  });
}

bool Actions::is_true_error_old() const {
  return true_error_.state() == BackgroundTask::State::kDone && true_error_key_ != session_.curve().key();
}

void Actions::fit() {
  const std::optional<FitJob> job = session_.fit_job();
  if (!job) {
    return session_.tell("a fit needs measured points, and parameters that are marked to vary", true);
  }
  if (!fit_.is_running()) session_.tell("");
  fit_.start([this, job = *job](const Progress& progress) -> BackgroundTask::Ending {
    const auto phase = [this](const std::string& name) { fit_.set_phase(name); };
    return [this, job, fit = run_fit(job, fit_evaluator_, progress, phase)] {
      return fit_text(fit, session_.take_fit(fit, job));
    };
  });
}

void Actions::finish() {
  for (BackgroundTask* task : {&table_, &true_error_}) task->finish();
  for (BackgroundTask* task : {&fit_, &plot_}) {
    if (!task->is_running()) continue;
    task->finish();
    if (!task->is_running()) session_.tell(task->message(), task->state() == BackgroundTask::State::kFailed);
  }
}

}  // namespace dolp::explore
