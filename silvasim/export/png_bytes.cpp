#include "silvasim/export/png_bytes.h"

#include <cairo.h>

#include <cmath>
#include <memory>

#include "silvasim/base/error.h"

namespace silvasim::exports {

namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) throw base::Error(std::string("cannot draw: ") + cairo_status_to_string(status));
}

Surface page(int width, int height) {
  Surface surface{cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), &cairo_surface_destroy};
  check(cairo_surface_status(surface.get()));
  return surface;
}

void copy(cairo_surface_t* surface, const Pixels& pixels, int left, int top) {
  cairo_surface_flush(surface);
  unsigned char* bytes = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  const std::uint8_t* from = pixels.rgb.data();
  for (int y = 0; y < pixels.height; ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(bytes + static_cast<std::ptrdiff_t>(y + top) * stride) + left;
    for (int x = 0; x < pixels.width; ++x, from += 3) {
      row[x] = std::uint32_t{from[0]} << 16 | std::uint32_t{from[1]} << 8 | from[2];
    }
  }
  cairo_surface_mark_dirty(surface);
}

std::string encoded(cairo_surface_t* surface) {
  std::string bytes;
  const auto append = [](void* target, const unsigned char* data, unsigned length) {
    static_cast<std::string*>(target)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  check(cairo_surface_write_to_png_stream(surface, append, &bytes));
  return bytes;
}

struct Pen {
  cairo_t* cairo;

  void use(Colour colour) const {
    cairo_set_source_rgb(cairo, ((colour >> 16) & 0xFF) / 255.0, ((colour >> 8) & 0xFF) / 255.0,
                         (colour & 0xFF) / 255.0);
  }
  void outline(Colour colour, double width) const {
    use(colour);
    cairo_set_line_width(cairo, width);
    cairo_stroke(cairo);
  }

  void operator()(const Text& text) const {
    cairo_save(cairo);
    cairo_select_font_face(cairo, font_family, text.font.italic ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL,
                           text.font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, text.font.size_px);
    const double width = width_px(text.text, text.font);
    cairo_translate(cairo, text.x, text.y);
    if (text.upward) cairo_rotate(cairo, -std::acos(0.0));
    cairo_move_to(cairo, text.anchor == Anchor::start ? 0 : text.anchor == Anchor::middle ? -width / 2 : -width, 0);
    use(text.colour);
    cairo_show_text(cairo, text.text.c_str());
    cairo_restore(cairo);
  }
  void operator()(const Rectangle& box) const {
    cairo_rectangle(cairo, box.x, box.y, box.width, box.height);
    if (box.fill) {
      use(*box.fill);
      box.stroke ? cairo_fill_preserve(cairo) : cairo_fill(cairo);
    }
    const double dashes[] = {6 * box.stroke_px, 4 * box.stroke_px};
    if (box.dashed) cairo_set_dash(cairo, dashes, 2, 0);
    if (box.stroke) outline(*box.stroke, box.stroke_px);
    cairo_set_dash(cairo, nullptr, 0, 0);
  }
  void operator()(const Line& line) const {
    cairo_move_to(cairo, line.x1, line.y1);
    cairo_line_to(cairo, line.x2, line.y2);
    outline(line.colour, line.width_px);
  }
  void operator()(const Circle& circle) const {
    cairo_new_path(cairo);  // text leaves a current point, and an arc begins with a line from it
    cairo_arc(cairo, circle.x, circle.y, circle.radius - circle.stroke_px / 2, 0, 4 * std::acos(0.0));
    use(circle.fill);
    cairo_fill_preserve(cairo);
    outline(circle.stroke, circle.stroke_px);
  }
  void operator()(const Triangle& t) const {
    cairo_move_to(cairo, t.x1, t.y1);
    cairo_line_to(cairo, t.x2, t.y2);
    cairo_line_to(cairo, t.x3, t.y3);
    cairo_close_path(cairo);
    use(t.fill);
    cairo_fill_preserve(cairo);
    outline(t.stroke, t.stroke_px);
  }
};

}  // namespace

std::string png_of(const Pixels& pixels) {
  const Surface surface = page(pixels.width, pixels.height);
  copy(surface.get(), pixels, 0, 0);
  return encoded(surface.get());
}

std::string png_of(const Layout& layout, const Pixels& map) {
  const Surface surface = page(layout.width_px, layout.height_px);
  const Context context{cairo_create(surface.get()), &cairo_destroy};
  const Pen pen{context.get()};
  pen.use(page_colour);
  cairo_paint(context.get());
  copy(surface.get(), map, layout.map_x, layout.map_y);
  cairo_set_line_join(context.get(), CAIRO_LINE_JOIN_MITER);
  // Text as the layout measured it: neither shape nor width follow the pixel grid.
  cairo_font_options_t* plain = cairo_font_options_create();
  cairo_font_options_set_hint_metrics(plain, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(plain, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_antialias(plain, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(context.get(), plain);
  cairo_font_options_destroy(plain);
  for (const Part& part : layout.parts) {
    for (const Mark& mark : part.marks) std::visit(pen, mark);
  }
  check(cairo_status(context.get()));
  return encoded(surface.get());
}

}  // namespace silvasim::exports
