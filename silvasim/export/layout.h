// Where everything stands on a picture: computed once, drawn by PNG and SVG alike.
//
// Units: pixels from the picture's north-west corner, y downwards. Text stands on its baseline.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "silvasim/ecosystem/ecosystem.h"
#include "silvasim/export/colour.h"
#include "silvasim/export/text.h"
#include "silvasim/export/view.h"

namespace silvasim::exports {

enum class Anchor { start, middle, end };

struct Text {
  double x = 0, y = 0;
  std::string text;
  Font font;
  Colour colour = 0;
  Anchor anchor = Anchor::start;
  bool upward = false;  // turned by 90 degrees, read from the right
};

struct Rectangle {
  double x = 0, y = 0, width = 0, height = 0;
  std::optional<Colour> fill, stroke;
  double stroke_px = 1;
  bool dashed = false;
};

struct Line {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
  Colour colour = 0;
  double width_px = 1;
};

struct Circle {
  double x = 0, y = 0, radius = 0;
  Colour fill = 0, stroke = 0;
  double stroke_px = 0;
};

struct Triangle {
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0, x3 = 0, y3 = 0;
  Colour fill = 0, stroke = 0;
  double stroke_px = 0;
};

using Mark = std::variant<Text, Rectangle, Line, Circle, Triangle>;

// Marks that belong together: "title", "frame", "legend", "scale-bar", "north-arrow", "caption".
struct Part {
  std::string id;
  std::vector<Mark> marks;
};

struct Layout {
  int width_px = 0, height_px = 0;
  int map_x = 0, map_y = 0;  // where the view's pixel (0, 0) lies
  View view;
  std::string title;        // as drawn, or as it would be drawn
  std::vector<Part> parts;  // over the map; empty for the bare map
};

inline constexpr Colour page_colour = 0xFFFFFF;
inline constexpr Colour ink_colour = 0x24302A;
inline constexpr Colour faint_colour = 0x6B756F;
inline constexpr Colour rule_colour = 0x9AA39D;

// `caption` tells how the map is drawn, which may depend on its scale.
// Errors: base::ConfigError where the width is out of range or the picture would be too tall.
Layout make_layout(const ecosystem::Ecosystem& ecosystem, const PreviewOptions& options, const Census& census,
                   const base::Box& box, const std::function<std::string(const View&)>& caption);

}  // namespace silvasim::exports
