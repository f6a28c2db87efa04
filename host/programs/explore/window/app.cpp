#include "explore/window/app.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "base/atomic_file.hpp"
#include "base/stopwatch.hpp"

namespace dolp::explore {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kBlink_s = 0.3;  // period in which the text cursor blinks
// While the user drags a slider, a frame waits at most this time for the curve. Tuned: with twice the time, frames of
// slow scenes take too long. With half the time, curves averaged over a wavelength band are not ready.
constexpr double kCatchUp_s = 0.03;
constexpr std::size_t kFramesAfterEvent = 4;  // ImGui draws some effects, such as an open list, some frames later
constexpr std::size_t kFramesAfterNews = 2;   // after results: ImGui needs a second frame to fit tables to new texts

std::string times_text(std::vector<double> times_s) {
  if (times_s.empty()) return "none";
  std::ranges::sort(times_s);
  return fmt::format("{} frames, median {:.1f} ms, worst {:.1f} ms", times_s.size(), 1e3 * times_s[times_s.size() / 2],
                     1e3 * times_s.back());
}

}  // namespace

App::App(SceneEdits edits, const AppOptions& options)
    : session_(std::move(edits)),
      evaluator_({.device = options.device, .is_interactive = true}),
      worker_(std::bind_front(&Evaluator::evaluate, &evaluator_),
              [this] {
                if (!is_catching_up_) glfwPostEmptyEvent();
              }),
      actions_(session_, options.device, options.command_line, options.preferences, glfwPostEmptyEvent),
      input_(screen_.window(), [this](const std::string& path) { actions_.open(path); }),
      ui_{session_, actions_} {}

void App::exchange() {
  actions_.finish();
  is_all_taken_ = worker_.is_idle();
  session_.take(worker_.take_news());
  if (!session_.take_changed()) return;
  std::vector<Job> jobs = session_.wanted();
  is_all_taken_ = is_all_taken_ && jobs.empty();
  worker_.want(std::move(jobs));
}

void App::catch_up() {
  if (input_.has_more() || !session_.is_dragged()) return;
  const Clock::time_point start = Clock::now();
  is_catching_up_ = true;
  for (exchange(); session_.curve().is_stale() && seconds_since(start) < kCatchUp_s; exchange())
    worker_.await_news(std::chrono::duration<double>(kCatchUp_s - seconds_since(start)));
  is_catching_up_ = false;
  exchange();
}

void App::draw() {
  screen_.follow(actions_.preferences());
  for (;;) {  // one frame of ImGui per waiting event; only the last is shown
    input_.begin_frame();
    draw_all(ui_, [this] { catch_up(); });
    if (!input_.has_more()) break;
    ImGui::EndFrame();
  }
  ImGui::Render();
  const std::string path = actions_.due_picture();
  const std::string png = screen_.show(!path.empty());
  if (png.empty()) return;
  actions_.picture_path.clear();
  write_text_atomically(path, png);
}

bool App::frame() {
  glfwPollEvents();
  exchange();
  draw();
  return glfwWindowShouldClose(screen_.window()) == GLFW_FALSE && !actions_.is_quitting;
}

void App::settle() {
  while (frame() && !is_idle()) {
  }
}

bool App::answer() {
  std::size_t left = kFramesAfterNews;
  while (left > 0) {
    if (!frame()) return false;
    const bool has_news = input_.take_news() || !actions_.picture_path.empty();
    if (session_.is_dragged()) return true;  // draws no more frames, so that the curves get the processor
    left = has_news ? kFramesAfterEvent : left - 1;
  }
  return true;
}

void App::close() {
  glfwSetWindowShouldClose(screen_.window(), GLFW_TRUE);
  glfwPostEmptyEvent();
}

void App::run() {
  // Wakes up to draw a tooltip when the mouse has rested for kTooltipDelay_s. The rest begins after the frames that
  // follow the last event, because on a slow machine these frames take long.
  const auto rest = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<float>(kTooltipDelay_s + 0.05F));
  Clock::time_point event, tooltip;
  while (answer()) {
    if (std::exchange(event, input_.last_event()) != input_.last_event()) tooltip = Clock::now() + rest;
    const double left_s = std::chrono::duration<double>(tooltip - Clock::now()).count();
    if (ImGui::GetIO().WantTextInput) {
      glfwWaitEventsTimeout(kBlink_s);
    } else if (left_s > 0.0) {
      glfwWaitEventsTimeout(left_s);
    } else {
      glfwWaitEvents();
    }
  }
}

std::string App::run_frames(std::size_t count, const std::string& screenshot_path) {
  std::vector<double> all_s, computing_s;  // durations: of all frames, and of frames during computations
  constexpr auto kPause = std::chrono::milliseconds(5);
  const bool wants_picture = !screenshot_path.empty();
  Clock::time_point start = Clock::now();
  for (std::size_t left = count; left > 0; --left) {
    // Waits for all results before the last frames. ImGui needs several frames to adapt its layout.
    if (wants_picture && left <= kFramesAfterEvent) {
      for (exchange(); !is_idle(); exchange()) std::this_thread::sleep_for(kPause);
      start = Clock::now();
    }
    if (wants_picture && left == 1) save_picture(screenshot_path);
    const bool was_computing = !worker_.is_idle();
    const bool is_open = frame();
    all_s.push_back(seconds_since(start));
    start = Clock::now();
    if (was_computing) computing_s.push_back(all_s.back());
    if (!is_open) break;
  }
  return fmt::format("frames     {}\ncomputing  {}\n", times_text(all_s), times_text(computing_s));
}

void run_program(const Scene& scene, const ProgramOptions& options) {
  if (!options.screenshot_path.empty()) {
    if (options.frames == 0)
      throw InputError("--screenshot needs --frames N beside it: the picture shows the last frame");
    if (std::filesystem::path(options.screenshot_path).extension() != ".png")
      throw InputError(fmt::format("--screenshot {}: the name must end in .png", options.screenshot_path));
    check_writable(options.screenshot_path);
  }
  require_device(options.device);
  AppOptions app_options = options;
  // Option --frames measures times or draws pictures for manuals. The user's preferences must not influence these.
  if (options.frames == 0) app_options.preferences = Preferences::default_path();
  App app(SceneEdits(scene), app_options);
  Session& session = app.session();
  const auto check = [&] {
    if (session.message().is_error) throw InputError(session.message().text);
  };
  if (!options.session_path.empty()) {
    open_file(session, options.session_path);
    check();
    session.set(options.settings);
    check();
  }
  const auto panel = std::ranges::find(kPanelNames, options.panel);
  if (panel != kPanelNames.end()) session.set_view(&View::panel, static_cast<Panel>(panel - kPanelNames.begin()));
  if (!options.measured_path.empty()) {
    session.load_measured(options.measured_path);
    check();
  }
  if (options.frames == 0) return app.run();
  fmt::print("{}", app.run_frames(options.frames, options.screenshot_path));
}

}  // namespace dolp::explore
