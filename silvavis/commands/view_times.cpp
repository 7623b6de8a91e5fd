#include "silvavis/commands/view_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace silvavis::commands {

namespace {

using Json = nlohmann::ordered_json;

struct Summary {
  std::size_t count = 0;
  double median_s = 0, worst_s = 0;
  double light_s = 0, trace_s = 0, tone_s = 0, show_s = 0;  // means
  double rays_a_second = 0;
  int coarseness_px = 0;  // median
};

Summary summary_of(const std::vector<PictureTimes>& all, bool anew) {
  Summary s;
  std::vector<double> seconds;
  std::vector<int> coarseness;
  double rays = 0;
  for (const PictureTimes& one : all) {
    if (one.anew != anew) continue;
    seconds.push_back(one.all_s());
    coarseness.push_back(one.coarseness_px);
    s.light_s += one.light_s;
    s.trace_s += one.trace_s;
    s.tone_s += one.tone_s;
    s.show_s += one.show_s;
    rays += static_cast<double>(one.rays);
  }
  s.count = seconds.size();
  if (seconds.empty()) return s;
  std::sort(seconds.begin(), seconds.end());
  std::sort(coarseness.begin(), coarseness.end());
  s.median_s = seconds[seconds.size() / 2];
  s.worst_s = seconds.back();
  s.coarseness_px = coarseness[coarseness.size() / 2];
  s.rays_a_second = rays / std::max(s.trace_s, 1e-9);
  for (double* part : {&s.light_s, &s.trace_s, &s.tone_s, &s.show_s}) *part /= static_cast<double>(s.count);
  return s;
}

Json json_of(const Summary& s) {
  Json json;
  json["count"] = s.count;
  if (s.count == 0) return json;
  json["median_ms"] = 1e3 * s.median_s;
  json["worst_ms"] = 1e3 * s.worst_s;
  json["coarseness_px"] = s.coarseness_px;
  json["rays_a_second"] = s.rays_a_second;
  json["mean_ms"] = {
      {"light", 1e3 * s.light_s}, {"trace", 1e3 * s.trace_s}, {"tone", 1e3 * s.tone_s}, {"show", 1e3 * s.show_s}};
  return json;
}

std::string line_of(const char* name, const Summary& s) {
  if (s.count == 0) return "";
  return fmt::format(
      "{} {} pictures: {:.0f} ms (at worst {:.0f}), {} px, {:.1f} million rays/s; light {:.0f}, rays {:.0f}, tone "
      "{:.0f}, "
      "window {:.0f} ms\n",
      s.count, name, 1e3 * s.median_s, 1e3 * s.worst_s, s.coarseness_px, s.rays_a_second / 1e6, 1e3 * s.light_s,
      1e3 * s.trace_s, 1e3 * s.tone_s, 1e3 * s.show_s);
}

}  // namespace

std::string ViewTimes::text() const {
  return line_of("first", summary_of(all_, true)) + line_of("refined", summary_of(all_, false));
}

std::string ViewTimes::json() const {
  return Json{{"first", json_of(summary_of(all_, true))}, {"refined", json_of(summary_of(all_, false))}}.dump();
}

}  // namespace silvavis::commands
