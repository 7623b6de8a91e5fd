#include "silvavis/commands/fly.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "silvasim/base/error.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvavis/commands/flight.h"
#include "silvavis/commands/sun_way.h"
#include "silvavis/image/file.h"
#include "silvavis/image/format.h"
#include "silvavis/image/tone.h"

namespace silvavis::commands {

namespace {

using Json = nlohmann::ordered_json;
using silvasim::terminal::wrong_option;

void check_numbers(const FlyOptions& o) {
  const auto positive = [](const std::optional<double>& value, const char* option, double most) {
    if (value && !(*value > 0 && *value <= most))
      wrong_option(fmt::format("{} {} should be above 0, at most {}", option, *value, most));
  };
  positive(o.fps, "--fps", 1000);
  positive(o.speed_m_s, "--speed", 1e6);
  positive(o.duration_s, "--duration", 24 * 3600);
  if (o.height_above_ground_m && !(std::abs(*o.height_above_ground_m) < 1e6))
    wrong_option(fmt::format("--height-above-ground {} should be metres", *o.height_above_ground_m));
  if (!(std::abs(o.look_down_deg) <= 89))
    wrong_option(fmt::format("--look-down {} should be -89 to 89", o.look_down_deg));
  if (o.overwrite && o.resume) wrong_option("--overwrite and --resume exclude each other");
  if (o.speed_m_s && o.duration_s) wrong_option("--speed and --duration exclude each other");
}

FlightOptions flight_options(const FlyOptions& options, const FlightPath& path) {
  FlightOptions flight;
  const bool timed = path.points.front().time_s.has_value();
  if (timed && (options.speed_m_s || options.duration_s))
    wrong_option("the path's points have times; --speed and --duration do not go with them");
  flight.fps = options.fps ? *options.fps : path.fps.value_or(25.0);
  if (options.speed_m_s) {
    flight.speed_m_s = *options.speed_m_s;
  } else {
    flight.duration_s = options.duration_s ? options.duration_s : path.duration_s;
  }
  flight.look_down_deg = options.look_down_deg;
  return flight;
}

struct Part {
  int first = 1, last = 1;
};

// "1-250", "17"
Part part_of(const std::string& text, int frames) {
  if (text.empty()) return {1, frames};
  Part part;
  const char* const end = text.data() + text.size();
  auto [at, error] = std::from_chars(text.data(), end, part.first);
  part.last = part.first;
  if (error == std::errc() && at != end && *at == '-') {
    const auto [rest, second] = std::from_chars(at + 1, end, part.last);
    at = rest;
    error = second;
  }
  if (error != std::errc() || at != end || part.first < 1 || part.last < part.first || part.last > frames)
    wrong_option(
        fmt::format("--frames \"{}\" should be a part of 1-{}, like 1-{}", text, frames, std::max(1, frames / 2)));
  return part;
}

// The frames to make: what is there already is asked for, kept or made anew, as the user says.
std::vector<int> frames_to_make(const FlyOptions& options, const FrameNames& name, Part part,
                                const std::vector<Path>& inputs) {
  std::vector<int> result;
  int there = 0, first_there = 0;
  std::error_code ignored;
  for (int number = part.first; number <= part.last; ++number) {
    const Path file = name(number);
    if (!std::filesystem::exists(file, ignored)) {
      result.push_back(number);
      continue;
    }
    for (const Path& input : inputs) {
      if (std::filesystem::equivalent(input, file, ignored))
        throw silvasim::base::Error("cannot write \"" + file.string() + "\": it is also an input");
    }
    if (there++ == 0) first_there = number;
    if (options.overwrite) result.push_back(number);
  }
  if (there > 0 && !options.overwrite && !options.resume) {
    throw silvasim::base::Error(
        fmt::format("{} of the frames {} to {} are there already, the first is \"{}\"; --overwrite makes them anew, "
                    "--resume makes only what is missing",
                    there, part.first, part.last, name(first_there).string()));
  }
  return result;
}

// Renders frames of one flight.
class Film {
 public:
  Film(const FlyOptions& options, Stage& stage, const Flight& flight, double fov_deg)
      : options_(options), stage_(stage), flight_(flight), sun_(options.picture.stage, options.sun_to, stage) {
    settings_ = settings_of(options.picture);
    settings_.camera.fov_deg = fov_deg;
    parse_size(options.picture.size, settings_.camera.width, settings_.camera.height);
  }

  image::Frame frame(int number, const silvasim::base::Progress& progress) {
    return picture(settings_, (number - 1) / fps(), number, progress);
  }

  const shade::Camera& camera() const { return camera_; }

  // From pictures of some thousand pixels, evenly over the flight.
  double exposure(const silvasim::base::Progress& progress) {
    constexpr int pictures = 5, side_px = 128;
    silvavis::RenderOptions small = settings_;
    const double shrink =
        std::min(1.0, static_cast<double>(side_px) / std::max(small.camera.width, small.camera.height));
    small.camera.width = std::max(1, static_cast<int>(std::lround(small.camera.width * shrink)));
    small.camera.height = std::max(1, static_cast<int>(std::lround(small.camera.height * shrink)));
    small.samples = 4;
    small.error = 0;
    small.aovs = true;
    std::vector<image::Image> seen;
    for (int i = 0; i < pictures; ++i) {
      const auto part = [&](std::string_view, double done) {
        silvasim::base::report(progress, "exposure", (i + done) / pictures);
        return true;
      };
      seen.push_back(image::land_of(picture(small, flight_.duration_s() * (i + 0.5) / pictures, 1, part)));
    }
    return image::automatic_exposure(seen);
  }

 private:
  double fps() const { return fps_; }

  image::Frame picture(silvavis::RenderOptions settings, double time_s, int number,
                       const silvasim::base::Progress& progress) {
    const Flight::View view = flight_.at(time_s);
    settings.camera.eye = view.eye;
    settings.camera.look_at = view.look_at;
    settings.seed += static_cast<std::uint64_t>(number - 1);
    camera_ = settings.camera;
    stage_.sun = sun_.at(time_s / std::max(flight_.duration_s(), 1e-9));
    set_light(stage_, options_.picture.stage, view.eye.z, haze_for(options_.picture, stage_, view.eye));
    return silvavis::render(stage_.scene, *stage_.tracer, *stage_.light, stage_.land, settings, progress);
  }

  const FlyOptions& options_;
  Stage& stage_;
  const Flight& flight_;
  SunWay sun_;
  silvavis::RenderOptions settings_;
  shade::Camera camera_;
  double fps_ = flight_.fps();
};

}  // namespace

FrameNames::FrameNames(const std::string& pattern) {
  const std::filesystem::path path(pattern);
  folder_ = path.parent_path();
  const std::string name = path.filename().string();
  const auto fail = [&](const std::string& what) {
    wrong_option("the output \"" + pattern + "\" " + what + "; write it like frames/%04d.png");
  };
  bool numbered = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    std::string& text = numbered ? after_ : before_;
    if (name[i] != '%') {
      text += name[i];
    } else if (i + 1 < name.size() && name[i + 1] == '%') {
      text += name[++i];
    } else {
      std::size_t end = i + 1;
      while (end < name.size() && name[end] >= '0' && name[end] <= '9') ++end;
      const std::string width = name.substr(i + 1, end - i - 1);
      if (end == name.size() || name[end] != 'd') fail("has a % that begins no frame number (%% is a %)");
      if (!width.empty() && (width.size() != 2 || width[0] != '0' || width[1] == '0'))
        fail("has a frame number with \"" + width + "\" digits; %d, or %01d to %09d");
      if (numbered) fail("has two frame numbers");
      numbered = true;
      digits_ = width.empty() ? 1 : static_cast<std::size_t>(width[1] - '0');
      i = end;
    }
  }
  if (!numbered) fail("has no frame number, so that all frames would have one name");
}

Path FrameNames::operator()(int number) const {
  return folder_ / (before_ + fmt::format("{:0{}}", number, digits_) + after_);
}

void fly(const FlyOptions& options) {
  const Common& common = options.picture.stage.common;
  const silvasim::base::ThreadLimit threads(common.threads);
  check_numbers(options);
  check_camera(options.picture);
  SunWay(options.picture.stage, options.sun_to, Stage{});  // says what is wrong with the sun's way
  const FrameNames name(options.output);
  image::WriteOptions write;
  write.exposure_stops = options.picture.exposure_stops;
  write.inputs = inputs_of(options.picture.stage);
  write.inputs.push_back(options.path);
  image::check_writable(name(1), write);
  const silvasim::base::Progress progress = silvasim::terminal::console_progress(common);
  FlightPath path;
  Part part;
  std::vector<int> numbers;
  const std::unique_ptr<Stage> stage = set_stage(options.picture.stage, progress, [&](const scene::Scene& bare) {
    path = read_path(options.path, bare, options.height_above_ground_m);
    const Flight flight(path, bare.ground, flight_options(options, path));
    part = part_of(options.frames, flight.frames());
    numbers = frames_to_make(options, name, part, write.inputs);
    std::vector<V3d> eyes;
    for (const int number : numbers) eyes.push_back(flight.frame(number).eye);
    return eyes;
  });
  const Flight flight(path, stage->scene.ground, flight_options(options, path));
  Film film(options, *stage, flight,
            options.fov_given ? options.picture.fov_deg : path.fov_deg.value_or(options.picture.fov_deg));

  const auto begin = std::chrono::steady_clock::now();
  const bool shown = image::format_of(name(1)) != image::Format::exr;
  if (shown && !numbers.empty() && !write.exposure_stops) write.exposure_stops = film.exposure(progress);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto within = [&](std::string_view, double done) {
      silvasim::base::report(progress, "fly", (static_cast<double>(i) + done) / static_cast<double>(numbers.size()));
      return true;
    };
    within("", 0);
    image::Frame frame = film.frame(numbers[i], within);
    keep_asked(frame, options.picture.aovs);
    write.metadata = metadata_of(*stage, film.camera());
    write.metadata["silva:frame"] = std::to_string(numbers[i]);
    image::write(name(numbers[i]), frame, write);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  silvasim::terminal::end_progress(common);

  const int kept = part.last - part.first + 1 - static_cast<int>(numbers.size());
  if (common.json) {
    Json json;
    json["output"] = options.output;
    json["frames"] = flight.frames();
    json["first"] = part.first;
    json["last"] = part.last;
    json["written"] = numbers.size();
    json["kept"] = kept;
    json["fps"] = flight.fps();
    json["duration_s"] = flight.duration_s();
    json["length_m"] = flight.length_m();
    json["exposure_stops"] = write.exposure_stops ? Json(*write.exposure_stops) : Json();
    json["plants"] = stage->scene.plants;
    json["peak_rss_bytes"] = silvasim::base::peak_rss_bytes();
    json["seconds"] = seconds;
    json["warnings"] = stage->warnings;
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
  } else if (!common.quiet) {
    fmt::print("{}: {} frames written{}, {} to {} of {}; {:.2f} s at {:g} frames a second, {:.0f} m; {:.1f} s\n",
               options.output, numbers.size(), kept > 0 ? fmt::format(", {} were there and were kept", kept) : "",
               part.first, part.last, flight.frames(), flight.duration_s(), flight.fps(), flight.length_m(), seconds);
  }
}

}  // namespace silvavis::commands
