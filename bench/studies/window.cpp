// The study of the window. On a virtual display, the program xdotool drags sliders with mouse events.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "base/stopwatch.hpp"
#include "explore/window/app.hpp"
#include "studies/child.hpp"
#include "studies/study.hpp"
#include "studies/study_run.hpp"
#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr int kWidth = 1920;
constexpr int kHeight = 1080;
constexpr double kDrag_s = 3.0;
constexpr int kMovesPerSecond = 30;
// Goals in fresh curves per second, for scenes with one wavelength and for scenes with a band. The study warns of drags
// that miss the goal. A curve is fresh if, when it appears, the slider still has the value for which it was computed.
constexpr double kGoalOfOne = 20.0;
constexpr double kGoalOfBand = 8.0;

/// A drag of the slider for the scene key `key`. The scene is kScene with `changes`.
struct DragCase {
  std::string name;
  std::string key;
  std::vector<Setting> changes;
  bool is_band = false;
};

const std::string kScene = R"(title = "Paint"
[surface]
n = 1.5
k = 0.1
sigma = 0.15
q = 3.0
masking = "smith"
specular = 0.97
diffuse = 0.03
[emission]
temperature_K = 290
[surroundings]
temperature_K = 240
[spectrum]
wavelength_um = 10.0
)";

const std::vector<DragCase>& drag_cases() {
  const std::vector<Setting> water = {{"surface.material", "water 25C"}, {"spectrum.band_um", {8.0, 14.0}}};
  static const std::vector<DragCase> all = {
      {"paint-10-um", "surface.sigma", {}},
      {"paint-10-um-n", "surface.n", {}},
      {"steel-10-um", "surface.sigma", {{"surface.n", 1.508}, {"surface.k", 0.0}, {"surface.masking", "integral"}}},
      {"water-8-14-um", "surface.sigma", water, true},
      {"water-8-14-um-temperature", "surroundings.temperature_K", water, true},
  };
  return all;
}

/// Runs Xvfb on a private display, and sets DISPLAY to this display.
class Display {
 public:
  Display() {
    int ends[2];
    if (::pipe(ends) != 0) throw IoError("no pipe for the display");
    const std::string end = std::to_string(ends[1]);
    const std::string screen = fmt::format("{}x{}x24", kWidth, kHeight);
    process_ = ::fork();
    if (process_ == 0) {
      ::execlp("Xvfb", "Xvfb", "-displayfd", end.c_str(), "-screen", "0", screen.c_str(), "-noreset", "-nolisten",
               "tcp", nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    std::string number;
    for (char one = 0; ::read(ends[0], &one, 1) == 1 && one != '\n';) number += one;
    ::close(ends[0]);
    if (number.empty()) throw DeviceError("no display for the window: Xvfb does not start");
    ::setenv("DISPLAY", (':' + number).c_str(), 1);
  }
  ~Display() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

 private:
  pid_t process_ = -1;
};

void xdotool(const std::string& commands) {
  const std::string find = "xdotool search --sync --name 'dolp explore' ";
  if (run_child({"sh", "-c", find + commands + " > /dev/null"}, ChildErrors::kShown).status != 0)
    throw IoError("xdotool fails");
}

/// Commands that drag a slider there and back. The button is down from the first move to the last.
std::string drag_commands(const explore::Area& slider) {
  const auto at = [&](double part) {
    const ImVec2 place = slider.at(static_cast<float>(part), 0.5F);
    return fmt::format("mousemove --window %1 {} {} ", std::lround(place.x), std::lround(place.y));
  };
  constexpr double kLow = 0.25, kHigh = 0.75;
  std::string commands = at(kLow) + "sleep 0.3 mousedown 1 ";
  const int moves = static_cast<int>(kDrag_s * kMovesPerSecond);
  for (int i = 1; i <= moves; ++i) {
    const double part = 2.0 * i / moves;
    commands += at(kLow + (kHigh - kLow) * (part < 1.0 ? part : 2.0 - part));
    commands += fmt::format("sleep {:.4f} ", 1.0 / kMovesPerSecond);
  }
  return commands + "mouseup 1";
}

/// Counts the curves, maps and frames that the window shows during a drag.
class Watch {
 public:
  explicit Watch(explore::App& app) : app_(app), scene_(curve().key()), shown_(shown_text()) {}

  void add(double frame_s) {
    const Clock::time_point now = Clock::now();
    if (curve().key() != std::exchange(scene_, curve().key())) {
      if (!begin_) begin_ = last_fresh_ = now;
      ++scenes_;
      end_ = now;
    }
    if (!begin_) return;
    frames_s_.push_back(frame_s);
    if (shown_text() != std::exchange(shown_, shown_text())) ++curves_;
    if (app_.session().map().version() != std::exchange(map_, app_.session().map().version())) ++maps_;
    if (curve().is_stale() || curve().key() == fresh_) return;
    fresh_ = curve().key();
    ++fresh_curves_;
    gap_s_ = std::max(gap_s_, std::chrono::duration<double>(now - last_fresh_).count());
    last_fresh_ = now;
  }
  /// True if the drag has begun and the curve is final: it belongs to the current scene and meets the tolerance.
  bool is_done() const { return begin_ && curve().is_finished(); }

  ordered_json json(Clock::time_point released) const {
    const double drag_s = std::chrono::duration<double>(end_ - *begin_).count();
    const auto rate = [&](int count) { return std::round(10.0 * count / drag_s) / 10.0; };
    const auto ms = [](double time_s) { return std::round(1e4 * time_s) / 10.0; };
    return {{"drag_s", rounded_time(drag_s)},
            {"moves", scenes_},
            {"curves_per_s", rate(curves_)},
            {"fresh_curves_per_s", rate(fresh_curves_)},
            {"longest_gap_s", rounded_time(gap_s_)},
            {"maps_per_s", rate(maps_)},
            {"final_s", rounded_time(std::max(0.0, std::chrono::duration<double>(Clock::now() - released).count()))},
            {"frames", frames_s_.size()},
            {"frame_ms_median", ms(median(frames_s_))},
            {"frame_ms_max", ms(*std::ranges::max_element(frames_s_))}};
  }

 private:
  const explore::Curve& curve() const { return app_.session().curve(); }
  /// A text that changes whenever the drawn curve changes.
  std::string shown_text() const {
    return explore::surface_name(curve().shown_scene()) + std::to_string(curve().points().size()) +
           std::to_string(curve().points().at(curve().points().size() / 2)[Quantity::kDolp]);
  }

  explore::App& app_;
  std::string scene_, shown_, fresh_;
  std::size_t map_ = 0;
  std::optional<Clock::time_point> begin_;
  Clock::time_point end_, last_fresh_;
  int scenes_ = 0, curves_ = 0, fresh_curves_ = 0, maps_ = 0;
  double gap_s_ = 0.0;
  std::vector<double> frames_s_;
};

ordered_json drag_row(const DragCase& one, const std::string& device) {
  explore::App app(explore::SceneEdits(Scene::from_text(kScene, one.changes, one.name)), {.device = device});
  xdotool(fmt::format("windowsize --sync %1 {} {} windowfocus %1", kWidth, kHeight));
  app.settle();
  // The first drag also compiles the kernels for coarse results. So the study reports only the second drag.
  ordered_json measured;
  for (int i = 0; i < 2; ++i) {
    Watch watch(app);
    std::atomic<bool> is_released = false;
    Clock::time_point released;
    std::jthread hand([&, commands = drag_commands(app.control_area(one.key))] {
      xdotool(commands);
      released = Clock::now();
      is_released = true;
    });
    app.run([&](double frame_s) {
      const bool is_over = is_released;
      watch.add(frame_s);
      if (is_over && watch.is_done()) app.close();
    });
    hand.join();
    measured = watch.json(released);
    app.reopen();
    app.settle();
  }
  ordered_json row = {{"scene", one.name}, {"key", one.key}, {"is_band", one.is_band}};
  row.update(measured);
  return row;
}

void measure_drags(StudyRun& run) {
  run.describe("window", "none", "seconds of a whole frame, from its events to the screen");
  std::vector<DragCase> cases = chosen(drag_cases(), run.options().cases, "--case");
  if (run.options().quick) std::erase_if(cases, [](const DragCase& one) { return one.name.size() > 13; });
  const Display display;
  run.expect(cases.size());
  for (const DragCase& one : cases) run.finish(drag_row(one, run.options().device));
  run.json()["screen"] = fmt::format("{} x {}", kWidth, kHeight);
  run.json()["moves_per_s"] = kMovesPerSecond;
  run.json()["drags"] = run.rows();
}

std::string table_text(const ordered_json& result) {
  std::string text = fmt::format("{:<28}{:>8}{:>8}{:>8}{:>9}{:>9}{:>12}{:>10}\n", "drag", "fresh/s", "all/s", "maps/s",
                                 "gap, s", "final, s", "median, ms", "worst, ms");
  for (const ordered_json& row : result["drags"]) {
    text += fmt::format("{:<28}{:>8}{:>8}{:>8}{:>9}{:>9}{:>12}{:>10}\n", row["scene"].get<std::string>(),
                        row["fresh_curves_per_s"].dump(), row["curves_per_s"].dump(), row["maps_per_s"].dump(),
                        row["longest_gap_s"].dump(), row["final_s"].dump(), row["frame_ms_median"].dump(),
                        row["frame_ms_max"].dump());
  }
  return text;
}

/// Warns of drags with fewer fresh curves per second than the goal.
void warn(ordered_json& result) {
  for (const ordered_json& row : result["drags"]) {
    const double goal = row["is_band"].get<bool>() ? kGoalOfBand : kGoalOfOne;
    const double rate = row["fresh_curves_per_s"].get<double>();
    if (rate >= goal) continue;
    result["warnings"].push_back(
        fmt::format("{}: {} fresh curves a second, the goal is {}", row["scene"].get<std::string>(), rate, goal));
  }
}

}  // namespace

void run_window(const StudyOptions& options) {
  check_device(options);
  run_study(options, {.measure = measure_drags, .table_text = table_text, .warn = warn});
}

}  // namespace dolp::bench
