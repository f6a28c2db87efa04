#include "explore/window/app.hpp"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <dolp/errors.hpp>
#include <filesystem>
#include <thread>

#include "base/atomic_file.hpp"
#include "base/stopwatch.hpp"
#include "device/context.hpp"
#include "device/result.hpp"
#include "explore/session_file.hpp"
#include "explore/window/actions.hpp"
#include "explore/window/input.hpp"
#include "explore/window/presenter.hpp"
#include "explore/window/ui.hpp"

namespace dolp::explore {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kWidth = 1440;
constexpr int kHeight = 900;
// Below it texts of the controls are cut.
constexpr int kLeastWidth = 800;
constexpr int kLeastHeight = 560;
constexpr double kBlink_s = 0.3;  // of a text cursor
// Chosen: of a frame of 33 ms, half of which is drawing. Twice as much makes slow scenes' frames long, half of it lets
// curves of a band lag behind the slider.
constexpr double kCatchUp_s = 0.03;
// Frames after an event: ImGui shows some answers, a list that opens for one, only frames later.
constexpr std::size_t kFramesAfterEvent = 4;
constexpr std::size_t kFramesAfterNews = 2;  // of the worker: tables take the width of their text a frame later

std::string glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "unknown reason";
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// GLFW, started and ended once.
struct Library {
  Library() {
    if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY"))
      throw DeviceError("no display for the window: neither DISPLAY nor WAYLAND_DISPLAY is set");
#ifdef GLFW_PLATFORM
    // Otherwise GLFW 3.4 tries Wayland first, whose library then prints a line of its own.
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
  int x = 0;
  int y = 0;
  int width = kWidth;
  int height = kHeight;
  float scale = 1.0F;
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    glfwGetMonitorContentScale(monitor, &scale, nullptr);
  }
  const auto scaled = [scale](int length) { return static_cast<int>(std::lround(scale * static_cast<float>(length))); };
  UniqueWindow window(glfwCreateWindow(std::min(scaled(kWidth), width), std::min(scaled(kHeight), height),
                                       "dolp explore", nullptr, nullptr));
  if (!window) throw DeviceError("the window cannot be opened: " + glfw_error());
  return window;
}

vulkan::Presentation presentation() {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (!names) throw DeviceError("no Vulkan driver was found that can show a window: " + glfw_error());
  const auto can_present = [](VkInstance instance, VkPhysicalDevice physical, std::uint32_t family) {
    return glfwGetPhysicalDevicePresentationSupport(instance, physical, family) == GLFW_TRUE;
  };
  return {{names, names + count}, can_present};
}

vulkan::Context make_context(const std::string& device) {
  const vulkan::Presentation wanted = presentation();
  return vulkan::Context({.device = device}, &wanted);
}

VkSurfaceKHR make_surface(VkInstance instance, GLFWwindow* window) {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  vulkan::check(glfwCreateWindowSurface(instance, window, nullptr, &surface), "connecting to the window");
  return surface;
}

VkExtent2D size_of(GLFWwindow* window) {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window, &width, &height);
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

/// Dear ImGui with the window's fonts and its input.
struct Gui {
  explicit Gui(GLFWwindow* of) : window(of) {
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

  /// Takes theme and scale. True where the font has changed.
  bool follow(const Preferences& wanted) {
    if (wanted.is_light != is_light()) set_theme(wanted.is_light);
    float display = 1.0F;
    glfwGetWindowContentScale(window, &display, nullptr);
    const float wanted_scale = display * static_cast<float>(wanted.zoom());
    if (wanted_scale == scale) return false;
    scale = wanted_scale;
    const bool is_light_now = is_light();
    ImGui::GetStyle() = ImGuiStyle();
    set_theme(is_light_now);
    ImGui::GetStyle().ScaleAllSizes(scale);
    ImGui::GetIO().Fonts->Clear();
    load_font(kFontPixels * scale);
    const auto scaled = [&](int length) { return static_cast<int>(std::lround(scale * static_cast<float>(length))); };
    glfwSetWindowSizeLimits(window, scaled(kLeastWidth), scaled(kLeastHeight), GLFW_DONT_CARE, GLFW_DONT_CARE);
    return true;
  }

  GLFWwindow* window;
  float scale = 0.0F;
};

double median_of(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

std::string times_text(const std::vector<double>& times_s) {
  if (times_s.empty()) return "none";
  return fmt::format("{} frames, median {:.1f} ms, worst {:.1f} ms", times_s.size(), 1e3 * median_of(times_s),
                     1e3 * *std::ranges::max_element(times_s));
}

/// Two lines: count, median and worst, of all frames and of those while something was computed.
std::string summary_of(const FrameTimes& times) {
  return fmt::format("frames     {}\ncomputing  {}\n", times_text(times.all_s), times_text(times.busy_s));
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

  /// Passes results in and wanted jobs out.
  void exchange() {
    actions.finish();
    is_all_taken = worker.is_idle();
    session.take(worker.take_news());
    if (!session.take_changed()) return;
    std::vector<Job> jobs = session.wanted();
    is_all_taken = is_all_taken && jobs.empty();
    worker.want(std::move(jobs));
  }

  /// Waits a moment for the coarse curve of a scene that the mouse moves, so that both move in the same frame.
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

  /// Draws a frame for each event, and shows the last.
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
    Picture picture;
    presenter.draw(ImGui::GetDrawData(), size_of(window.get()), path.empty() ? nullptr : &picture);
    if (picture.width > 0) {
      actions.set_picture({});
      write_png(picture, path);
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
  std::atomic<bool> is_catching_up = false;  ///< takes news without being woken up
  Worker worker;
  Actions actions;
  Ui ui;
  bool is_all_taken = false;
};

App::App(SceneEdits edits, const AppOptions& options) : impl_(std::make_unique<Impl>(std::move(edits), options)) {}

App::~App() = default;

Session& App::session() { return impl_->session; }

Area App::control_area(const std::string& key) const { return impl_->ui.area(key); }

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
    if (impl_->session.is_dragged()) return true;  // one frame for each move: the processor is for the curves
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
    // A note appears when the mouse has rested, a little more than a frame later at most.
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

FrameTimes App::run_frames(std::size_t count, const std::string& screenshot_path) {
  FrameTimes times;
  const bool wants_picture = !screenshot_path.empty();
  Clock::time_point start = Clock::now();
  for (std::size_t left = count; left > 0; --left) {
    // The last frames show what is finished, in a layout that has settled.
    if (wants_picture && left <= kFramesAfterEvent) {
      impl_->wait_for_results();
      start = Clock::now();
    }
    if (wants_picture && left == 1) save_picture(screenshot_path);
    const bool was_computing = !impl_->worker.is_idle();
    const bool is_open = frame();
    const Clock::time_point end = Clock::now();
    times.all_s.push_back(std::chrono::duration<double>(end - start).count());
    if (was_computing) times.busy_s.push_back(times.all_s.back());
    start = end;
    if (!is_open) break;
  }
  return times;
}

void run_program(const Scene& scene, const ProgramOptions& options) {
  if (!options.screenshot_path.empty() && options.frames == 0) {
    throw InputError("--screenshot needs --frames N beside it: the picture is of the last frame");
  }
  if (!options.screenshot_path.empty()) check_writable(options.screenshot_path);
  // Pictures for manuals and measurements show what everyone sees.
  const std::filesystem::path preferences = options.frames == 0 ? Preferences::default_path() : "";
  App app(SceneEdits(scene), {options.device, options.command_line, preferences});
  const auto check = [&] {
    if (app.session().message().is_error) throw InputError(app.session().message().text);
  };
  if (!options.session_path.empty()) {
    open_file(app.session(), options.session_path);
    check();
    app.session().set(options.settings);
    check();
  }
  if (!options.panel.empty()) {
    View view = app.session().view();
    view.panel = panel_of(options.panel);
    app.session().set_view(view);
  }
  if (!options.measured_path.empty()) {
    app.session().load_measured(options.measured_path);
    check();
  }
  if (options.frames == 0) {
    app.run();
  } else {
    fmt::print("{}", summary_of(app.run_frames(options.frames, options.screenshot_path)));
  }
}

}  // namespace dolp::explore
