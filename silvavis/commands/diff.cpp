#include "silvavis/commands/diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "silvasim/base/error.h"
#include "silvavis/image/compare.h"
#include "silvavis/image/file.h"

namespace silvavis::commands {

namespace {

using silvasim::base::Error;

struct Metric {
  std::string name;
  double value = 0;
  bool whole = false;         // a count
  bool better_above = false;  // a similarity
};

void add_light(std::vector<Metric>& metrics, const std::string& what, const image::Difference& d) {
  metrics.push_back({what + "mean_absolute", d.mean_absolute});
  metrics.push_back({what + "rmse", d.rmse});
  metrics.push_back({what + "greatest", d.greatest});
  metrics.push_back({what + "share_different", d.share_different});
  metrics.push_back({what + "not_finite", static_cast<double>(d.not_finite), true});
}

template <class Id>
void add_ids(std::vector<Metric>& metrics, const std::string& what, const std::vector<Id>& a,
             const std::vector<Id>& b) {
  if (a.empty() || b.empty()) return;
  const image::IdDifference d = image::compare_ids(std::span(a), std::span(b));
  metrics.push_back({what + "different", static_cast<double>(d.different), true});
  metrics.push_back({what + "share_different", d.share_different});
}

std::vector<Metric> measured(const DiffOptions& options) {
  const image::Frame a = image::read_frame(options.a), b = image::read_frame(options.b);
  image::CompareOptions compare;
  compare.threshold = static_cast<float>(options.threshold);
  const image::Difference colour = image::compare(a.colour, b.colour, compare);
  std::vector<Metric> metrics;
  metrics.push_back({"pixels", static_cast<double>(colour.pixels), true});
  add_light(metrics, "", colour);
  metrics.push_back({"psnr_db", colour.psnr_db, false, true});
  metrics.push_back({"ssim", colour.ssim, false, true});
  metrics.push_back({"brightness_ratio", colour.brightness_ratio});
  compare.ssim = false;
  if (!a.depth.empty() && !b.depth.empty()) add_light(metrics, "depth_", image::compare(a.depth, b.depth, compare));
  if (!a.normal.empty() && !b.normal.empty()) {
    add_light(metrics, "normal_", image::compare(a.normal, b.normal, compare));
  }
  add_ids(metrics, "species_", a.species, b.species);
  add_ids(metrics, "plant_", a.plants, b.plants);
  return metrics;
}

std::vector<Metric> chosen(const std::vector<Metric>& all, const std::vector<std::string>& names) {
  if (names.empty()) return all;
  std::vector<std::string> known;
  for (const Metric& metric : all) known.push_back(metric.name);
  std::vector<Metric> result;
  for (const std::string& name : names) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at == known.end()) {
      throw Error(fmt::format("there is no metric \"{}\" for these pictures{}; there are {}", name,
                              silvasim::base::did_you_mean(name, known), fmt::join(known, ", ")));
    }
    result.push_back(all[static_cast<std::size_t>(at - known.begin())]);
  }
  return result;
}

std::string value_text(const Metric& metric) {
  return metric.whole ? fmt::format("{:.0f}", metric.value) : fmt::format("{:.6g}", metric.value);
}

void check_limit(const DiffOptions& options, const std::vector<Metric>& metrics) {
  if (!options.at_most) return;
  if (metrics.size() != 1) throw Error("a limit needs exactly one metric");
  const Metric& metric = metrics[0];
  const bool kept = metric.better_above ? metric.value >= *options.at_most : metric.value <= *options.at_most;
  if (!kept) {
    throw Error(fmt::format("\"{}\" and \"{}\" differ: {} is {}, {} than {}", options.a.string(), options.b.string(),
                            metric.name, value_text(metric), metric.better_above ? "less" : "more", *options.at_most));
  }
}

std::string text_of(const DiffOptions& options, const std::vector<Metric>& metrics) {
  if (options.json) {
    nlohmann::ordered_json json;
    for (const Metric& metric : metrics) {
      if (!std::isfinite(metric.value)) {
        json[metric.name] = nullptr;
      } else if (metric.whole) {
        json[metric.name] = static_cast<std::uint64_t>(metric.value);
      } else {
        json[metric.name] = metric.value;
      }
    }
    return json.dump(2) + "\n";
  }
  std::string text;
  for (const Metric& metric : metrics) text += fmt::format("{:<24}{}\n", metric.name, value_text(metric));
  return text;
}

}  // namespace

std::string diff_text(const DiffOptions& options) {
  return text_of(options, chosen(measured(options), options.metrics));
}

void diff(const DiffOptions& options) {
  const std::vector<Metric> metrics = chosen(measured(options), options.metrics);
  fmt::print("{}", text_of(options, metrics));
  check_limit(options, metrics);
}

}  // namespace silvavis::commands
