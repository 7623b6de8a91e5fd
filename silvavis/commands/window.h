// A window that shows pictures, and what its user did. The only place that knows SDL.
//
// Errors: base::Error where there is no display. Threads: one, the program's first.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace silvavis::commands {

// Keys are characters: capitals, digits and signs as they are; W A S D Q E are places on the keyboard, the same ones on any layout.
inline constexpr char key_escape = '\x1b', key_left = '\x01', key_right = '\x02', key_up = '\x03', key_down = '\x04';

struct Press {
  char key = 0;
  bool shift = false;

  friend bool operator==(const Press&, const Press&) = default;
};

struct Input {
  bool closed = false;
  std::vector<Press> presses;  // since the last call, with the keyboard's repetitions
  std::string held;            // keys that are down now
  bool shift = false;
  double drag_x_px = 0, drag_y_px = 0;  // of the mouse with its left button down, to the right and down
  double wheel = 0;                     // notches, up is positive
  int width_px = 0, height_px = 0;      // of the window

  bool holds(char key) const { return held.find(key) != std::string::npos; }
};

class Window {
 public:
  Window();  // looks for a display; shows nothing yet
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void open(const std::string& title, int width_px, int height_px);
  void set_title(const std::string& title);

  // Columns x rows of 3 bytes, from the upper left, each of which covers `side_px` x `side_px` pixels of the window; smooth between.
  void show(const std::vector<std::uint8_t>& rgb, int columns, int rows, int side_px = 1);

  // What happened since the last call; where nothing did, after that time at the latest.
  Input input(double wait_s = 0);
  bool has_input();

  // As if the user did it.
  void send_key(Press press, bool down);
  void send_drag(double x_px, double y_px);
  void send_wheel(double notches);
  void send_size(int width_px, int height_px);

 private:
  struct Inner;
  std::unique_ptr<Inner> inner_;
};

}  // namespace silvavis::commands
