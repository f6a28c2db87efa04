#include "explore/window/app.hpp"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <dolp/errors.hpp>
#include <filesystem>
#include <thread>

#include "base/atomic_file.hpp"
#include "device/context.hpp"
#include "device/result.hpp"
#include "explore/exports.hpp"
#include "explore/fitting.hpp"
#include "explore/window/png.hpp"
#include "explore/window/presenter.hpp"
#include "explore/window/text.hpp"
#include "explore/window/ui.hpp"
#include "explore/worker.hpp"

namespace dolp::explore {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kWidth = 1440;
constexpr int kHeight = 900;
constexpr float kFontPixels = 15.0F;
constexpr auto kFading = std::chrono::milliseconds(300);  // of a dialog that was closed
constexpr double kBlink_s = 0.3;                          // of a text cursor
// Frames after an event: ImGui shows some answers, a list that opens for one, only frames later.
constexpr std::size_t kFramesAfterEvent = 4;

std::string glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "unknown reason";
}

/// GLFW, started and ended once.
struct Library {
  Library() {
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

struct ImGuiOwner {
  ImGuiOwner() { ImGui::CreateContext(); }
  ~ImGuiOwner() { ImGui::DestroyContext(); }
  ImGuiOwner(const ImGuiOwner&) = delete;
  ImGuiOwner& operator=(const ImGuiOwner&) = delete;
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

Evaluator make_evaluator(const std::string& device) { return Evaluator({.device = device, .is_interactive = true}); }

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
struct Interface {
  explicit Interface(GLFWwindow* window) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    ImGui::StyleColorsDark();
    float scale = 1.0F;
    glfwGetWindowContentScale(window, &scale, nullptr);
    ImGui::GetStyle().ScaleAllSizes(scale);
    load_font(kFontPixels * scale);
    ImGui_ImplGlfw_InitForVulkan(window, true);
  }
  ~Interface() { ImGui_ImplGlfw_Shutdown(); }
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;
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

}  // namespace

std::string summary_of(const FrameTimes& times) {
  return fmt::format("frames     {}\ncomputing  {}\n", times_text(times.all_s), times_text(times.busy_s));
}

class App::Impl {
 public:
  Impl(SceneEdits edits, const AppOptions& options)
      : session_(std::move(edits)),
        window_(open_window()),
        context_(make_context(options.device)),
        interface_(prepared(window_.get())),
        presenter_(context_, make_surface(context_.instance(), window_.get()), size_of(window_.get())),
        evaluator_(make_evaluator(options.device)),
        export_evaluator_(make_evaluator(options.device)),
        fit_evaluator_(make_evaluator(options.device)),
        worker_([this](const Scene& scene, const PointList& list,
                       const RunOptions& run) { return evaluate(evaluator_, scene, list, run); },
                glfwPostEmptyEvent),
        table_export_(glfwPostEmptyEvent),
        true_error_(glfwPostEmptyEvent),
        fit_(glfwPostEmptyEvent),
        command_line_(options.command_line),
        ui_(session_, table_export_, true_error_, fit_, actions(), options.file_name) {
    glfwSetWindowUserPointer(window_.get(), this);
  }

  Session& session() { return session_; }
  const ControlsPanel& controls() const { return ui_.controls(); }
  const Area& plot() const { return ui_.plot(); }
  GLFWwindow* window() const { return window_.get(); }
  void close() {
    glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
    glfwPostEmptyEvent();
  }
  /// True where there was input since the last call.
  bool take_input() { return std::exchange(has_input_, false); }
  bool is_idle() const {
    const std::scoped_lock lock(found_mutex_);
    return worker_.is_idle() && is_all_taken_ && fit_.state() != BackgroundTask::State::kRunning && !found_;
  }
  bool is_computing() const { return !worker_.is_idle(); }
  void save_picture(const std::string& path, Clock::duration delay = {}) {
    picture_path_ = path;
    picture_time_ = Clock::now() + delay;
  }
  bool has_picture_to_save() const { return !picture_path_.empty(); }

  /// Passes results in and wanted jobs out.
  void exchange() {
    if (std::optional<FitFound> found = take_found()) session_.take_fit(std::move(*found));
    is_all_taken_ = worker_.is_idle();
    session_.take(worker_.take_news());
    if (!session_.take_changed()) return;
    std::vector<Job> jobs = session_.wanted();
    is_all_taken_ = is_all_taken_ && jobs.empty();
    worker_.want(std::move(jobs));
  }

  void draw() {
    const bool wants_picture = has_picture_to_save() && Clock::now() >= picture_time_;
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    ui_.draw();
    ImGui::Render();
    Picture picture;
    presenter_.draw(ImGui::GetDrawData(), size_of(window_.get()), wants_picture ? &picture : nullptr);
    if (wants_picture && picture.width > 0) write_png(picture, std::exchange(picture_path_, {}));
    context_.check_validation();
  }

 private:
  static Impl* impl_of(GLFWwindow* window) { return static_cast<Impl*>(glfwGetWindowUserPointer(window)); }

  /// Installs our own callbacks, which ImGui calls after its own; until the user pointer is set they do nothing.
  static GLFWwindow* prepared(GLFWwindow* window) {
    glfwSetKeyCallback(window, [](GLFWwindow* of, int key, int, int action, int modifiers) {
      note_input(of);
      const bool is_command = action == GLFW_PRESS && modifiers == GLFW_MOD_CONTROL;
      if (is_command && impl_of(of)) impl_of(of)->ui_.press(key);
    });
    glfwSetDropCallback(window, [](GLFWwindow* of, int count, const char** paths) {
      note_input(of);
      if (count > 0 && impl_of(of)) impl_of(of)->session_.load_measured(paths[0]);
    });
    glfwSetCharCallback(window, [](GLFWwindow* of, unsigned) { note_input(of); });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* of, int, int, int) { note_input(of); });
    glfwSetCursorPosCallback(window, [](GLFWwindow* of, double, double) { note_input(of); });
    glfwSetScrollCallback(window, [](GLFWwindow* of, double, double) { note_input(of); });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* of, int) { note_input(of); });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* of, int) { note_input(of); });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* of, int, int) { note_input(of); });
    glfwSetWindowRefreshCallback(window, note_input);
    return window;
  }

  static void note_input(GLFWwindow* window) {
    if (impl_of(window)) impl_of(window)->has_input_ = true;
  }

  /// Runs an action that may fail for a reason that the user can fix.
  void attempt(const std::string& done, const std::function<void()>& body) {
    try {
      body();
      session_.tell(done);
    } catch (const std::exception& error) {
      session_.tell(error.what(), true);
    }
  }

  Actions actions() {
    Actions actions;
    actions.save_scene = [this](const std::string& path) {
      attempt("saved " + path, [&] {
        const std::filesystem::path folder = std::filesystem::path(path).parent_path();
        write_text_atomically(path, session_.scene().toml(folder.empty() ? "." : folder));
      });
    };
    actions.save_curve = [this](const std::string& path) {
      if (!session_.curve().is_finished()) {
        session_.tell("the curve is not finished yet", true);
        return;
      }
      attempt("saved " + path, [&] { write_text_atomically(path, session_.curve().report().csv); });
    };
    actions.save_picture = [this](const std::string& path) {
      attempt("saved " + path, [&] {
        check_writable(path);
        save_picture(path, kFading);
      });
    };
    actions.load_measured = [this](const std::string& path) { session_.load_measured(path); };
    actions.export_table = [this](const std::string& path) { start_export(path); };
    actions.find_true_error = [this] {
      true_error_.start([curve = session_.curve()](const Progress& progress) { return true_error(curve, progress); });
    };
    actions.fit = [this] { start_fit(); };
    actions.quit = [this] { close(); };
    return actions;
  }

  void start_export(const std::string& path) {
    table_export_.start([this, path, scene = session_.scene()](const Progress& progress) {
      return export_table(scene, path, command_line_, export_evaluator_, progress);
    });
  }

  void start_fit() {
    std::optional<FitJob> job = session_.fit_job();
    if (!job) {
      session_.tell("a fit needs measured points, and parameters that are marked to vary", true);
      return;
    }
    fit_.start([this, job = std::move(*job)](const Progress& progress) {
      FitFound found = run_fit(job, fit_evaluator_, progress);
      const std::scoped_lock lock(found_mutex_);
      found_ = std::move(found);
      return found_->text;
    });
  }

  /// The result of a fit that finished since the last call.
  std::optional<FitFound> take_found() {
    const std::scoped_lock lock(found_mutex_);
    return std::exchange(found_, std::nullopt);
  }

  Session session_;
  Library library_;
  UniqueWindow window_;
  vulkan::Context context_;
  ImGuiOwner imgui_;
  Interface interface_;
  Presenter presenter_;
  // Each with a device of its own, so that none waits for another.
  Evaluator evaluator_;
  Evaluator export_evaluator_;
  Evaluator fit_evaluator_;
  Worker worker_;
  mutable std::mutex found_mutex_;
  std::optional<FitFound> found_;  ///< of a fit that has ended
  BackgroundTask table_export_;
  BackgroundTask true_error_;
  BackgroundTask fit_;
  std::string command_line_;
  std::string picture_path_;
  Clock::time_point picture_time_;
  bool is_all_taken_ = false;
  bool has_input_ = false;
  Ui ui_;
};

App::App(SceneEdits edits, const AppOptions& options) : impl_(std::make_unique<Impl>(std::move(edits), options)) {}

App::~App() = default;

Session& App::session() { return impl_->session(); }

Area App::control_area(const std::string& key) const { return impl_->controls().areas().at(key); }

Area App::plot_area() const { return impl_->plot(); }

bool App::is_idle() const { return impl_->is_idle(); }

void App::save_picture(const std::string& path) { impl_->save_picture(path); }

void App::resize(int width, int height) { glfwSetWindowSize(impl_->window(), width, height); }

bool App::frame() {
  glfwPollEvents();
  impl_->exchange();
  impl_->draw();
  return glfwWindowShouldClose(impl_->window()) == GLFW_FALSE;
}

void App::settle() {
  while (frame() && !is_idle()) {
  }
}

bool App::answer() {
  std::size_t left = kFramesAfterEvent;
  while (left > 0) {
    if (!frame()) return false;
    left = impl_->take_input() || impl_->has_picture_to_save() ? kFramesAfterEvent : left - 1;
  }
  return true;
}

void App::close() { impl_->close(); }

void App::run() {
  while (answer()) {
    if (ImGui::GetIO().WantTextInput) {
      glfwWaitEventsTimeout(kBlink_s);
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
      wait_for_results();
      start = Clock::now();
    }
    if (wants_picture && left == 1) impl_->save_picture(screenshot_path);
    const bool was_computing = impl_->is_computing();
    const bool is_open = frame();
    const Clock::time_point end = Clock::now();
    times.all_s.push_back(std::chrono::duration<double>(end - start).count());
    if (was_computing) times.busy_s.push_back(times.all_s.back());
    start = end;
    if (!is_open) break;
  }
  return times;
}

void App::wait_for_results() {
  constexpr auto kPause = std::chrono::milliseconds(5);
  for (impl_->exchange(); !is_idle(); impl_->exchange()) std::this_thread::sleep_for(kPause);
}

}  // namespace dolp::explore
