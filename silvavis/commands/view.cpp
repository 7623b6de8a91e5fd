#include "silvavis/commands/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "silvasim/base/error.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvavis/commands/cameras.h"
#include "silvavis/commands/fly.h"
#include "silvavis/commands/pilot.h"
#include "silvavis/commands/sun_way.h"
#include "silvavis/commands/view_script.h"
#include "silvavis/commands/view_times.h"
#include "silvavis/commands/window.h"
#include "silvavis/image/file.h"
#include "silvavis/image/tone.h"
#include "silvavis/progressive.h"

namespace silvavis::commands {

namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr double picture_s = 0.09;       // ten pictures a second, and a little to spare
constexpr double scripted_step_s = 0.1;  // what a picture counts under a script
constexpr int pictures_a_rest = 3;
constexpr double idle_s = 0.1, longest_step_s = 0.25;
constexpr double turn_deg_s = 45, fast = 4, notch = 1.25;
constexpr double stops_a_press = 0.25, sun_step_min = 30;

double seconds_since(Clock::time_point& mark) {
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - mark).count();
  mark = now;
  return seconds;
}

class Session {
 public:
  Session(const ViewOptions& options, Stage& stage, Window& window, const image::WriteOptions& write)
      : options_(options),
        stage_(stage),
        window_(window),
        write_(write),
        names_(options.picture.output.string()),
        settings_(settings_of(options.picture)),
        progressive_(stage.scene, *stage.tracer, stage.land) {
    settings_.aovs = false;
    settings_.camera = start_ = camera_for(options.picture, stage.scene);
    if (options.picture.stage.sun_direction.empty()) moment_ = moment_of("--sun", options.picture.stage.sun);
    go_to(start_);
    set_light(stage_, options_.picture.stage, settings_.camera.eye.z,
              haze_for(options_.picture, stage_, settings_.camera.eye));
    light_eye_ = settings_.camera.eye;
    if (options.picture.exposure_stops) automatic_stops_ = *options.picture.exposure_stops;
  }

  void run(std::optional<ScriptPlayer> player) {
    auto last = Clock::now();
    bool again = true;
    for (std::int64_t pictures = 0; !options_.frames || pictures < *options_.frames;) {
      if (silvasim::base::interrupted()) throw silvasim::base::Cancelled();
      if (player && !player->step(window_, progressive_.finished() && !again)) return;
      const bool idle = progressive_.finished() && !again;
      if (idle && options_.frames && !player) return;
      const Input input = window_.input(idle && !player ? idle_s : 0);
      if (input.closed) return;
      const double passed = seconds_since(last);
      if (!obey(input)) return;
      again |= fly(input, player ? scripted_step_s : std::min(passed, longest_step_s));
      again |= std::exchange(changed_, false);
      if (!again && progressive_.finished()) continue;
      show_next(again);
      ++pictures;
      // Once more for an eye that rests elsewhere than the light was made for.
      again = !again && wants_other_light();
      if (again) renew_light();
    }
  }

  const ViewTimes& times() const { return times_; }
  const std::vector<std::string>& cameras() const { return cameras_; }
  const std::vector<std::string>& saved() const { return saved_; }
  std::string eye_text() const { return place_text(stage_.scene, settings_.camera.eye); }
  std::string look_at_text() const { return place_text(stage_.scene, settings_.camera.look_at); }
  const silvavis::RenderOptions& settings() const { return settings_; }

 private:
  void go_to(const shade::Camera& camera) {
    pilot_ = pilot_of(camera, stage_.scene.ground);
    settings_.camera.eye = camera.eye;
    settings_.camera.look_at = camera.look_at;
    if (pilot_.eye != camera.eye) follow_pilot();
  }

  void follow_pilot() {
    settings_.camera.eye = as_printed(pilot_.eye);
    settings_.camera.look_at = as_printed(look_at_of(pilot_));
  }

  // To the millimetre, in the scene's metres: a camera that is printed and read again is the same to the last bit, and so is
  // the grain of its picture.
  V3d as_printed(const V3d& p) const {
    const silvasim::base::Point& origin = stage_.scene.origin;
    const auto rounded = [](double at) { return std::round(at * 1000) / 1000; };
    return {rounded(p.x + origin.x) - origin.x, rounded(p.y + origin.y) - origin.y, rounded(p.z)};
  }

  // Keys that are commands. False: end.
  bool obey(const Input& input) {
    for (const Press& press : input.presses) {
      switch (press.key) {
        case key_escape:
          return false;
        case '+':
          user_stops_ += stops_a_press;
          exposed_ = false;
          break;
        case '-':
          user_stops_ -= stops_a_press;
          exposed_ = false;
          break;
        case 'T':
          move_sun(press.shift ? -sun_step_min : sun_step_min);
          break;
        case 'L':
          settings_.lod = !settings_.lod;
          changed_ = true;
          break;
        case 'P':
          save();
          break;
        case 'C':
          print_camera();
          break;
        case 'R':
          go_to(start_);
          changed_ = true;
          break;
        default:
          break;
      }
    }
    if (!exposed_ && !changed_ && progressive_.finished()) present();
    return true;
  }

  // Whether the eye is elsewhere now.
  bool fly(const Input& input, double seconds) {
    const auto down = [&](char key) {
      return input.holds(key) || std::any_of(input.presses.begin(), input.presses.end(),
                                             [&](const Press& press) { return press.key == key; });
    };
    const auto axis = [&](char plus, char minus) { return static_cast<double>(down(plus)) - down(minus); };
    const Pilot before = pilot_;
    pilot_.pace = std::clamp(pilot_.pace * std::pow(notch, input.wheel), 0.01, 100.0);
    // The point that was gripped stays under the mouse.
    const double deg_a_pixel = settings_.camera.fov_deg / settings_.camera.width;
    turn(pilot_, turn_deg_s * seconds * axis(key_right, key_left) - input.drag_x_px * deg_a_pixel,
         turn_deg_s * seconds * axis(key_up, key_down) + input.drag_y_px * deg_a_pixel);
    const Push push{axis('W', 'S'), axis('D', 'A'), axis('E', 'Q')};
    move(pilot_, push, seconds * (input.shift ? fast : 1), stage_.scene.ground);
    const bool resized = input.width_px > 0 && input.height_px > 0 &&
                         (input.width_px != settings_.camera.width || input.height_px != settings_.camera.height);
    if (resized) {
      settings_.camera.width = input.width_px;
      settings_.camera.height = input.height_px;
    }
    const bool moved =
        pilot_.eye != before.eye || pilot_.heading_deg != before.heading_deg || pilot_.pitch_deg != before.pitch_deg;
    if (moved) follow_pilot();
    return moved || resized;
  }

  // The sky looks other from high above; while the eye moves, small differences can wait.
  void follow_height() {
    const double lowest_m = static_cast<double>(stage_.scene.ground.pyramid.origin_m);
    const double now_m = settings_.camera.eye.z - lowest_m, light_m = light_eye_.z - lowest_m;
    if (std::abs(now_m - light_m) > 100 + 0.25 * std::max(light_m, 0.0)) renew_light();
  }

  bool wants_other_light() const {
    const V3d& eye = settings_.camera.eye;
    if (eye == light_eye_) return false;
    const auto thinned = [&](const V3d& at) { return haze_for(options_.picture, stage_, at).share < 1; };
    return eye.z != light_eye_.z || thinned(eye) || thinned(light_eye_);
  }

  void renew_light() {
    set_light(stage_, options_.picture.stage, settings_.camera.eye.z,
              haze_for(options_.picture, stage_, settings_.camera.eye));
    light_eye_ = settings_.camera.eye;
  }

  void move_sun(double minutes) {
    if (!moment_) {
      if (!options_.picture.stage.common.quiet)
        fmt::print(stderr, "silvavis: warning: the sun stands still under --sun-direction; begin with --sun\n");
      return;
    }
    moment_ = later(*moment_, minutes, stage_.longitude_deg);
    stage_.sun = shade::sun_position(*moment_, stage_.longitude_deg, stage_.latitude_deg);
    renew_light();
    changed_ = true;
  }

  void show_next(bool anew) {
    PictureTimes picture;
    auto mark = Clock::now();
    if (anew) {
      follow_height();
      progressive_.look(*stage_.light, settings_);
      shown_camera_ = settings_.camera;
    }
    picture.light_s = seconds_since(mark);
    const std::uint64_t rays_before = rays();
    const double time_s = std::max(0.02, picture_s - overhead_s_);
    progressive_.refine(time_s);
    // At rest there is more time between two pictures, as long as the user lets it be.
    for (int i = 1; i < pictures_a_rest && !anew && !progressive_.finished() && !window_.has_input(); ++i)
      progressive_.refine(time_s);
    picture.trace_s = seconds_since(mark);
    picture.rays = rays() - rays_before;
    picture.coarseness_px = progressive_.coarseness_px();
    picture.anew = anew;
    expose();
    const image::Image& shown = as_sampled();
    const auto bytes = image::srgb_bytes(image::tone_mapped(shown, automatic_stops_ + user_stops_));
    picture.tone_s = seconds_since(mark);
    window_.show(bytes, shown.width, shown.height, progressive_.coarseness_px());
    window_.set_title(title(picture));
    picture.show_s = seconds_since(mark);
    overhead_s_ += 0.3 * (picture.tone_s + picture.show_s - overhead_s_);
    exposed_ = true;
    times_.add(picture);
  }

  const image::Image& as_sampled() {
    return progressive_.coarseness_px() > 1 ? progressive_.squares() : progressive_.picture();
  }

  // The same picture with another exposure.
  void present() {
    window_.show(image::srgb_bytes(image::tone_mapped(progressive_.picture(), automatic_stops_ + user_stops_)),
                 settings_.camera.width, settings_.camera.height);
    exposed_ = true;
  }

  std::uint64_t rays() const { return progressive_.statistics().eye_rays + progressive_.statistics().shadow_rays; }

  // The eye gets used to other light by and by; a finished picture has the exposure that `render` gives it.
  void expose() {
    if (options_.picture.exposure_stops) return;
    const bool at_once = times_.pictures() == 0 || progressive_.finished();
    constexpr std::size_t every = 4;  // pictures: metering takes rays too
    if (at_once || times_.pictures() % every == 0) wanted_stops_ = metered_exposure(stage_, settings_);
    automatic_stops_ = at_once ? wanted_stops_ : automatic_stops_ + 0.2 * (wanted_stops_ - automatic_stops_);
  }

  std::string title(const PictureTimes& picture) const {
    const double height_m = height_above_ground_m(pilot_, stage_.scene.ground);
    const std::string hour = moment_ ? fmt::format(", {:02}:{:02}", moment_->hour, moment_->minute) : "";
    const std::string fineness =
        progressive_.coarseness_px() > 1
            ? fmt::format("{} px coarse", progressive_.coarseness_px())
            : fmt::format("{:.1f} of {} samples", progressive_.samples_a_pixel(), settings_.samples);
    return fmt::format("silvavis {} - {:.0f} ms, {:.1f} million rays/s, {:.{}f} m above ground, {:.0f} m/s{}, {}{}",
                       options_.picture.stage.ecosystem.filename().string(), 1e3 * picture.all_s(),
                       static_cast<double>(picture.rays) / std::max(picture.trace_s, 1e-9) / 1e6, height_m,
                       height_m < 100 ? 1 : 0, speed_m_s(pilot_, stage_.scene.ground), hour, fineness,
                       settings_.lod ? "" : ", no levels");
  }

  void save() {
    if (times_.pictures() == 0) return;
    try {
      while (std::filesystem::exists(names_(next_name_))) ++next_name_;
      image::WriteOptions write = write_;
      write.exposure_stops = automatic_stops_ + user_stops_;
      write.metadata = metadata_of(stage_, shown_camera_);
      image::Frame frame;
      frame.colour = progressive_.picture();
      image::write(names_(next_name_), frame, write);
      saved_.push_back(names_(next_name_).string());
      if (!options_.picture.stage.common.quiet) fmt::print(stderr, "silvavis: saved {}\n", saved_.back());
    } catch (const silvasim::base::Error& error) {
      // A full disk does not end a flight.
      fmt::print(stderr, "silvavis: warning: {}\n", error.what());
    }
  }

  void print_camera() {
    const shade::Camera& camera = settings_.camera;
    const auto spot = [&](const char* tag, const V3d& p) {
      return fmt::format("<{} x=\"{:.3f}\" y=\"{:.3f}\" height=\"{:.3f}\"/>", tag, p.x + stage_.scene.origin.x,
                         p.y + stage_.scene.origin.y, p.z);
    };
    cameras_.push_back(fmt::format("<camera name=\"view-{}\" fov=\"{}\">{}{}</camera>", cameras_.size() + 1,
                                   camera.fov_deg, spot("eye", camera.eye), spot("look-at", camera.look_at)));
    if (options_.picture.stage.common.json) return;
    fmt::print("{}\n", cameras_.back());
    std::fflush(stdout);
  }

  const ViewOptions& options_;
  Stage& stage_;
  Window& window_;
  const image::WriteOptions& write_;
  FrameNames names_;
  silvavis::RenderOptions settings_;
  Progressive progressive_;
  shade::Camera start_, shown_camera_;
  Pilot pilot_;
  std::optional<shade::Moment> moment_;
  V3d light_eye_{0, 0, 0};
  double wanted_stops_ = 0, automatic_stops_ = 0, user_stops_ = 0;
  double overhead_s_ = 0.02;  // of tone mapping and showing
  bool changed_ = false;      // by a key: the picture must begin anew
  bool exposed_ = true;       // what is shown has the exposure that is asked for
  int next_name_ = 1;
  std::vector<std::string> cameras_, saved_;
  ViewTimes times_;
};

}  // namespace

void view(const ViewOptions& options) {
  const Common& common = options.picture.stage.common;
  const silvasim::base::ThreadLimit threads(common.threads);
  check_camera(options.picture);
  image::WriteOptions write;
  write.inputs = inputs_of(options.picture.stage);
  if (!options.picture.camera.empty()) write.inputs.push_back(camera_file(options.picture.camera));
  image::check_writable(FrameNames(options.picture.output.string())(1), write);
  std::optional<ScriptPlayer> player;
  if (options.script) player.emplace(read_script(*options.script));
  int width = 0, height = 0;
  parse_size(options.picture.size, width, height);
  Window window;

  const silvasim::base::Progress progress = silvasim::terminal::console_progress(common);
  // With levels in any case, so that L can turn them on.
  StageOptions stage_options = options.picture.stage;
  stage_options.lod = "auto";
  const std::unique_ptr<Stage> stage =
      set_stage(stage_options, progress, [&](const scene::Scene& bare) { return eyes_of(options.picture, bare); });
  silvasim::terminal::end_progress(common);
  Session session(options, *stage, window, write);
  window.open("silvavis " + stage_options.ecosystem.filename().string(), width, height);
  session.run(std::move(player));

  if (common.json) {
    Json json;
    json["plants"] = stage->scene.plants;
    json["size"] = {session.settings().camera.width, session.settings().camera.height};
    json["eye"] = session.eye_text();
    json["look_at"] = session.look_at_text();
    json["sun"] = {{"azimuth_deg", stage->sun.azimuth_deg}, {"elevation_deg", stage->sun.elevation_deg}};
    json["levels"] = session.settings().lod;
    json["pictures"] = Json::parse(session.times().json());
    json["cameras"] = session.cameras();
    json["saved"] = session.saved();
    json["peak_rss_bytes"] = silvasim::base::peak_rss_bytes();
    json["threads"] = silvasim::base::thread_count();
    json["warnings"] = stage->warnings;
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
  } else if (!common.quiet) {
    fmt::print(stderr, "{}", session.times().text());
  }
}

}  // namespace silvavis::commands
