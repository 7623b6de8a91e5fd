// silvavis view: fly through an ecosystem in a window.
//
// While the eye moves there is a picture every tenth of a second, as fine as the machine allows; at rest it gets better until it is
// what `silvavis render` gives with the same options.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "silvavis/commands/render.h"

namespace silvavis::commands {

struct ViewOptions {
  RenderOptions picture;               // its output is a pattern of names for what P saves: view-%04d.png
  std::optional<Path> script;          // view_script.h
  std::optional<std::int64_t> frames;  // ends after so many pictures
};

inline constexpr const char* view_keys =
    "Drag the mouse to look around. W A S D fly ahead, left, back, right; E and Q up and down; the arrows turn. The "
    "wheel changes the "
    "speed, Shift flies four times as fast. + and - lighten and darken; T and Shift+T move the sun half an hour; L "
    "turns levels of detail "
    "on and off; P saves the picture; C prints the camera for cameras.xml; R returns to the beginning; Esc ends.";

void view(const ViewOptions& options);

}  // namespace silvavis::commands
