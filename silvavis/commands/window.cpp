#include "silvavis/commands/window.h"

#include <SDL.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "silvasim/base/error.h"

namespace silvavis::commands {

namespace {

// By place.
constexpr std::array<std::pair<SDL_Scancode, char>, 6> places{{{SDL_SCANCODE_W, 'W'},
                                                               {SDL_SCANCODE_A, 'A'},
                                                               {SDL_SCANCODE_S, 'S'},
                                                               {SDL_SCANCODE_D, 'D'},
                                                               {SDL_SCANCODE_Q, 'Q'},
                                                               {SDL_SCANCODE_E, 'E'}}};
// By what is printed on them.
constexpr std::array<std::pair<SDL_Keycode, char>, 9> signs{{{SDLK_ESCAPE, key_escape},
                                                             {SDLK_LEFT, key_left},
                                                             {SDLK_RIGHT, key_right},
                                                             {SDLK_UP, key_up},
                                                             {SDLK_DOWN, key_down},
                                                             {SDLK_EQUALS, '+'},
                                                             {SDLK_KP_PLUS, '+'},
                                                             {SDLK_PLUS, '+'},
                                                             {SDLK_KP_MINUS, '-'}}};

char key_of(const SDL_Keysym& keysym) {
  for (const auto& [code, key] : places)
    if (keysym.scancode == code) return key;
  for (const auto& [code, key] : signs)
    if (keysym.sym == code) return key;
  if (keysym.sym >= 32 && keysym.sym < 127) return static_cast<char>(std::toupper(static_cast<int>(keysym.sym)));
  return 0;
}

SDL_Keysym keysym_of(Press press) {
  SDL_Keysym keysym{};
  keysym.sym = std::tolower(static_cast<unsigned char>(press.key));
  keysym.mod = press.shift ? KMOD_LSHIFT : KMOD_NONE;
  for (const auto& [code, key] : places)
    if (press.key == key) keysym.scancode = code;
  for (const auto& [code, key] : signs)
    if (press.key == key) keysym.sym = code;
  return keysym;
}

[[noreturn]] void fail(const std::string& what) { throw silvasim::base::Error(what + ": " + SDL_GetError()); }

}  // namespace

struct Window::Inner {
  SDL_Window* window = nullptr;
  SDL_Renderer* renderer = nullptr;
  SDL_Texture* texture = nullptr;
  int texture_columns = 0, texture_rows = 0;
  std::string held;
  bool shift = false;

  void take(const SDL_Event& event, Input& input) {
    switch (event.type) {
      case SDL_QUIT:
        input.closed = true;
        break;
      case SDL_KEYDOWN:
      case SDL_KEYUP: {
        shift = (event.key.keysym.mod & KMOD_SHIFT) != 0;
        const char key = key_of(event.key.keysym);
        if (key == 0) break;
        std::erase(held, key);
        if (event.type == SDL_KEYUP) break;
        held += key;
        // With Ctrl or Alt it belongs to the desktop.
        if ((event.key.keysym.mod & (KMOD_CTRL | KMOD_ALT)) == 0) input.presses.push_back({key, shift});
        break;
      }
      case SDL_MOUSEMOTION:
        if ((event.motion.state & SDL_BUTTON_LMASK) == 0) break;
        input.drag_x_px += event.motion.xrel;
        input.drag_y_px += event.motion.yrel;
        break;
      case SDL_MOUSEWHEEL:
        input.wheel += static_cast<double>(event.wheel.preciseY);
        break;
      case SDL_WINDOWEVENT:
        // What is released elsewhere is never told.
        if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) {
          held.clear();
          shift = false;
        }
        break;
      default:
        break;
    }
  }
};

Window::Window() : inner_(std::make_unique<Inner>()) {
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
  const auto no_display = [](const std::string& reason) {
    throw silvasim::base::Error("there is no display to open a window on (" + reason +
                                "); start it on a desktop, or make pictures without a window by silvavis render");
  };
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY") && !std::getenv("SDL_VIDEODRIVER"))
    no_display("neither DISPLAY nor WAYLAND_DISPLAY is set");
  if (SDL_Init(SDL_INIT_VIDEO) != 0) no_display(SDL_GetError());
  // SDL's last resort draws where nobody sees it; whoever wants that says so.
  const std::string driver = SDL_GetCurrentVideoDriver();
  if ((driver == "offscreen" || driver == "dummy" || driver == "evdev") && !std::getenv("SDL_VIDEODRIVER")) {
    SDL_Quit();
    no_display("SDL found only its \"" + driver + "\" driver");
  }
}

Window::~Window() {
  if (inner_->texture) SDL_DestroyTexture(inner_->texture);
  if (inner_->renderer) SDL_DestroyRenderer(inner_->renderer);
  if (inner_->window) SDL_DestroyWindow(inner_->window);
  SDL_Quit();
}

void Window::open(const std::string& title, int width_px, int height_px) {
  inner_->window = SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, width_px, height_px,
                                    SDL_WINDOW_RESIZABLE);
  if (!inner_->window) fail("cannot open a window");
  inner_->renderer = SDL_CreateRenderer(inner_->window, -1, 0);
  if (!inner_->renderer) fail("cannot draw into the window");
}

void Window::set_title(const std::string& title) { SDL_SetWindowTitle(inner_->window, title.c_str()); }

void Window::show(const std::vector<std::uint8_t>& rgb, int columns, int rows, int side_px) {
  Inner& in = *inner_;
  if (!in.texture || in.texture_columns != columns || in.texture_rows != rows) {
    if (in.texture) SDL_DestroyTexture(in.texture);
    in.texture = SDL_CreateTexture(in.renderer, SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STREAMING, columns, rows);
    if (!in.texture) fail("cannot draw into the window");
    SDL_SetTextureScaleMode(in.texture, SDL_ScaleModeLinear);
    in.texture_columns = columns;
    in.texture_rows = rows;
  }
  const SDL_Rect place{0, 0, columns * side_px, rows * side_px};
  SDL_UpdateTexture(in.texture, nullptr, rgb.data(), columns * 3);
  SDL_RenderClear(in.renderer);
  SDL_RenderCopy(in.renderer, in.texture, nullptr, &place);
  SDL_RenderPresent(in.renderer);
}

bool Window::has_input() {
  SDL_PumpEvents();
  return SDL_HasEvents(SDL_FIRSTEVENT, SDL_LASTEVENT) == SDL_TRUE;
}

Input Window::input(double wait_s) {
  Input input;
  SDL_Event event;
  if (wait_s > 0 && SDL_WaitEventTimeout(&event, static_cast<int>(std::ceil(wait_s * 1000))))
    inner_->take(event, input);
  while (SDL_PollEvent(&event)) inner_->take(event, input);
  input.held = inner_->held;
  input.shift = inner_->shift;
  SDL_GetWindowSize(inner_->window, &input.width_px, &input.height_px);
  return input;
}

void Window::send_key(Press press, bool down) {
  SDL_Event event{};
  event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
  event.key.state = down ? SDL_PRESSED : SDL_RELEASED;
  event.key.keysym = keysym_of(press);
  SDL_PushEvent(&event);
}

void Window::send_drag(double x_px, double y_px) {
  SDL_Event event{};
  event.type = SDL_MOUSEMOTION;
  event.motion.state = SDL_BUTTON_LMASK;
  event.motion.xrel = static_cast<int>(std::lround(x_px));
  event.motion.yrel = static_cast<int>(std::lround(y_px));
  SDL_PushEvent(&event);
}

void Window::send_wheel(double notches) {
  SDL_Event event{};
  event.type = SDL_MOUSEWHEEL;
  event.wheel.preciseY = static_cast<float>(notches);
  SDL_PushEvent(&event);
}

void Window::send_size(int width_px, int height_px) { SDL_SetWindowSize(inner_->window, width_px, height_px); }

}  // namespace silvavis::commands
