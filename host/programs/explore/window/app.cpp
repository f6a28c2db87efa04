#include "explore/window/app.hpp"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <dolp/errors.hpp>

#include "base/atomic_file.hpp"
#include "base/stopwatch.hpp"
#include "device/result.hpp"
#include "explore/window/presenter.hpp"
#include "explore/window/ui.hpp"

namespace dolp::explore {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kWidth = 1440;
constexpr int kHeight = 900;
// A smaller window would cut off texts of the controls.
constexpr int kLeastWidth = 800;
constexpr int kLeastHeight = 560;
constexpr double kBlink_s = 0.3;  // period of a text cursor
// Tuned for frames of 33 ms, half of which is drawing. At double, slow scenes have long frames. At half, curves of a
// band lag behind the slider.
constexpr double kCatchUp_s = 0.03;
// ImGui shows some reactions, for example an open list, only some frames after the event.
constexpr std::size_t kFramesAfterEvent = 4;
// after new results, because tables adapt to the width of their text one frame later
constexpr std::size_t kFramesAfterNews = 2;

std::string glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "unknown reason";
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// A length of the window in whole pixels at a scale.
int scaled_length(int length, float scale) { return static_cast<int>(std::lround(scale * static_cast<float>(length))); }

/// Starts GLFW once and ends it.
struct Library {
  Library() {
    if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY"))
      throw DeviceError("no display for the window: neither DISPLAY nor WAYLAND_DISPLAY is set");
#ifdef GLFW_PLATFORM
    // Otherwise GLFW 3.4 tries Wayland first, and the Wayland library prints a line.
    if (!is_set("WAYLAND_DISPLAY")) glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
    if (glfwInit() == GLFW_FALSE) throw DeviceError("no display for the window: " + glfw_error());
    if (glfwVulkanSupported() == GLFW_FALSE) {
      glfwTerminate();
      throw DeviceError("no Vulkan driver was found that can show a window");
    }
  }
  ~Library() { glfwTerminate(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

struct DestroyWindow {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using UniqueWindow = std::unique_ptr<GLFWwindow, DestroyWindow>;

/// Opens a window as large as its content at the display's scale, or as the display.
UniqueWindow open_window() {
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  int x = 0, y = 0, width = kWidth, height = kHeight;
  float scale = 1.0F;
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    glfwGetMonitorContentScale(monitor, &scale, nullptr);
  }
  UniqueWindow window(glfwCreateWindow(std::min(scaled_length(kWidth, scale), width),
                                       std::min(scaled_length(kHeight, scale), height), "dolp explore", nullptr,
                                       nullptr));
  if (!window) throw DeviceError("the window cannot be opened: " + glfw_error());
  return window;
}

/// A device that can show a window.
vulkan::Context make_context(const std::string& device) {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (!names) throw DeviceError("no Vulkan driver was found that can show a window: " + glfw_error());
  const auto can_present = [](VkInstance instance, VkPhysicalDevice physical, std::uint32_t family) {
    return glfwGetPhysicalDevicePresentationSupport(instance, physical, family) == GLFW_TRUE;
  };
  const vulkan::Presentation wanted{{names, names + count}, can_present};
  return vulkan::Context({.device = device}, &wanted);
}

VkSurfaceKHR make_surface(VkInstance instance, GLFWwindow* window) {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  vulkan::check(glfwCreateWindowSurface(instance, window, nullptr, &surface), "connecting to the window");
  return surface;
}

VkExtent2D size_of(GLFWwindow* window) {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window, &width, &height);
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

/// Dear ImGui with the window's theme and font.
struct Gui {
  explicit Gui(GLFWwindow* shown_window) : window(shown_window) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    follow({});
    ImGui_ImplGlfw_InitForVulkan(window, false);
  }
  ~Gui() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// Applies theme and scale. Returns true if the font has changed.
  bool follow(const Preferences& wanted) {
    if (wanted.is_light != is_light()) set_theme(wanted.is_light);
    float display = 1.0F;
    glfwGetWindowContentScale(window, &display, nullptr);
    const float wanted_scale = display * static_cast<float>(wanted.zoom());
    if (wanted_scale == scale) return false;
    scale = wanted_scale;
    ImGui::GetStyle() = ImGuiStyle();
    set_theme(wanted.is_light);
    ImGui::GetStyle().ScaleAllSizes(scale);
    ImGui::GetIO().Fonts->Clear();
    load_font(kFontPixels * scale);
    glfwSetWindowSizeLimits(window, scaled_length(kLeastWidth, scale), scaled_length(kLeastHeight, scale),
                            GLFW_DONT_CARE, GLFW_DONT_CARE);
    return true;
  }

  GLFWwindow* window;
  float scale = 0.0F;
};

/// Count, median and worst of durations of frames.
std::string times_text(std::vector<double> times_s) {
  if (times_s.empty()) return "none";
  std::ranges::sort(times_s);
  return fmt::format("{} frames, median {:.1f} ms, worst {:.1f} ms", times_s.size(), 1e3 * times_s[times_s.size() / 2],
                     1e3 * times_s.back());
}

}  // namespace

struct App::Impl {
  Impl(SceneEdits edits, const AppOptions& options)
      : session(std::move(edits)),
        window(open_window()),
        context(make_context(options.device)),
        gui(window.get()),
        input(window.get(), [this](const std::string& path) { actions.open(path); }),
        presenter(context, make_surface(context.instance(), window.get()), size_of(window.get())),
        evaluator({.device = options.device, .is_interactive = true}),
        worker([this](const Scene& scene, const PointList& list,
                      const RunOptions& run) { return evaluate(evaluator, scene, list, run); },
               [this] {
                 if (!is_catching_up) glfwPostEmptyEvent();
               }),
        actions(session, options.device, options.command_line, options.preferences, glfwPostEmptyEvent),
        ui(session, actions, [this] { catch_up(); }) {}

  /// Passes results to the session and wanted jobs to the worker.
  void exchange() {
    actions.finish();
    is_all_taken = worker.is_idle();
    session.take(worker.take_news());
    if (!session.take_changed()) return;
    std::vector<Job> jobs = session.wanted();
    is_all_taken = is_all_taken && jobs.empty();
    worker.want(std::move(jobs));
  }

  /// During a drag, waits briefly for the coarse curve, so that slider and curve move in the same frame.
  void catch_up() {
    if (input.has_more() || !session.is_dragged()) return;
    const Clock::time_point start = Clock::now();
    is_catching_up = true;
    for (exchange(); session.curve().is_stale() && seconds_since(start) < kCatchUp_s; exchange()) {
      worker.await_news(std::chrono::duration<double>(kCatchUp_s - seconds_since(start)));
    }
    is_catching_up = false;
    exchange();
  }

  /// Draws a frame for each event, and presents the last one.
  void draw() {
    if (gui.follow(actions.preferences())) presenter.restart_imgui();
    for (;;) {
      ImGui_ImplVulkan_NewFrame();
      input.begin_frame();
      ui.draw();
      if (!input.has_more()) break;
      ImGui::EndFrame();
    }
    ImGui::Render();
    const std::string path = actions.due_picture();
    const std::string png = presenter.draw(ImGui::GetDrawData(), size_of(window.get()), !path.empty());
    if (!png.empty()) {
      actions.set_picture({});
      write_text_atomically(path, png);
    }
    context.check_validation();
  }

  void wait_for_results() {
    constexpr auto kPause = std::chrono::milliseconds(5);
    for (exchange(); !is_idle(); exchange()) std::this_thread::sleep_for(kPause);
  }

  bool is_idle() { return worker.is_idle() && is_all_taken && !actions.fit_task().is_running(); }

  Session session;
  Library library;
  UniqueWindow window;
  vulkan::Context context;
  Gui gui;
  Input input;
  Presenter presenter;
  Evaluator evaluator;
  std::atomic<bool> is_catching_up = false;  ///< while true, news need not wake the window by an event
  Worker worker;
  Actions actions;
  Ui ui;
  bool is_all_taken = false;
};

App::App(SceneEdits edits, const AppOptions& options) : impl_(std::make_unique<Impl>(std::move(edits), options)) {}

App::~App() = default;

Session& App::session() { return impl_->session; }
Area App::control_area(const std::string& name) const { return impl_->input.areas().at(name); }
const CurveView& App::curve_view() const { return impl_->ui.curves(); }
const MapView& App::map_view() const { return impl_->ui.map(); }
bool App::is_idle() const { return impl_->is_idle(); }
void App::save_picture(const std::string& path) { impl_->actions.set_picture(path); }

bool App::frame() {
  glfwPollEvents();
  impl_->exchange();
  impl_->draw();
  return glfwWindowShouldClose(impl_->window.get()) == GLFW_FALSE && !impl_->actions.is_quitting();
}

void App::settle() {
  while (frame() && !is_idle()) {
  }
}

bool App::answer(const AfterFrame& after_frame) {
  std::size_t left = kFramesAfterNews;
  while (left > 0) {
    const Clock::time_point start = Clock::now();
    const bool is_open = frame();
    if (after_frame) after_frame(seconds_since(start));
    if (!is_open) return false;
    const bool has_news = impl_->input.take_news() || impl_->actions.has_picture_to_save();
    if (impl_->session.is_dragged()) return true;  // one frame per move leaves the processor to the curves
    left = has_news ? kFramesAfterEvent : left - 1;
  }
  return true;
}

void App::close() {
  glfwSetWindowShouldClose(impl_->window.get(), GLFW_TRUE);
  glfwPostEmptyEvent();
}

void App::reopen() { glfwSetWindowShouldClose(impl_->window.get(), GLFW_FALSE); }

void App::run(const AfterFrame& after_frame) {
  while (answer(after_frame)) {
    // A note appears slightly after the delay for the resting mouse.
    constexpr double kNote_s = static_cast<double>(kTooltipDelay_s) + 0.05;
    if (ImGui::GetIO().WantTextInput) {
      glfwWaitEventsTimeout(kBlink_s);
    } else if (const double rest_s = impl_->input.rest_s(); rest_s < kNote_s) {
      glfwWaitEventsTimeout(kNote_s - rest_s);
    } else {
      glfwWaitEvents();
    }
  }
}

std::string App::run_frames(std::size_t count, const std::string& screenshot_path) {
  std::vector<double> all_s, computing_s;  // time between the starts of frames: all, and while the worker was busy
  const bool wants_picture = !screenshot_path.empty();
  Clock::time_point start = Clock::now();
  for (std::size_t left = count; left > 0; --left) {
    // Waits with the last frames until all results are there and the layout is stable.
    if (wants_picture && left <= kFramesAfterEvent) {
      impl_->wait_for_results();
      start = Clock::now();
    }
    if (wants_picture && left == 1) save_picture(screenshot_path);
    const bool was_computing = !impl_->worker.is_idle();
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
    check_writable(options.screenshot_path);
  }
  // Pictures for manuals and measurements do not depend on the user's preferences.
  const std::filesystem::path preferences = options.frames == 0 ? Preferences::default_path() : "";
  App app(SceneEdits(scene), {options.device, options.command_line, preferences});
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
  if (!options.panel.empty()) session.set_view(&View::panel, panel_of(options.panel));
  if (!options.measured_path.empty()) {
    session.load_measured(options.measured_path);
    check();
  }
  if (options.frames == 0) return app.run();
  fmt::print("{}", app.run_frames(options.frames, options.screenshot_path));
}

}  // namespace dolp::explore
