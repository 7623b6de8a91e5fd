// What a user would do in the window, written down: for tests, measurements and recordings.
//
//   # a line a step
//   hold W 20         hold keys (one or several letters) for so many pictures
//   press T           press a key; "press shift+T", "press Esc", "press Left"
//   drag -120 0       drag the mouse, in pixels
//   wheel 2           turn the wheel
//   resize 640 360    change the window
//   wait 5            let so many pictures pass; without a number, until the picture is finished
//
// Under a script each picture counts as a tenth of a second, so that the eye's way does not depend on the machine.
// Errors: base::ConfigError with file and line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include "silvavis/commands/window.h"

namespace silvavis::commands {

struct ScriptStep {
  enum class Kind { hold, press, drag, wheel, resize, wait, finish };
  Kind kind = Kind::wait;
  std::vector<Press> keys;  // of hold and press
  double x = 0, y = 0;
  int pictures = 0;  // of hold and wait
};

std::vector<ScriptStep> read_script(const std::filesystem::path& file);

// Sends the steps to a window, picture by picture.
class ScriptPlayer {
 public:
  explicit ScriptPlayer(std::vector<ScriptStep> steps) : steps_(std::move(steps)) {}

  // Before each picture; `finished`: nothing is left to refine. False: the script is through.
  bool step(Window& window, bool finished);

 private:
  std::vector<ScriptStep> steps_;
  std::size_t at_ = 0;
  int shown_ = 0;  // pictures of this step
};

}  // namespace silvavis::commands
