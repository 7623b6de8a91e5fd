// The command line of silvavis.
#include <CLI/CLI.hpp>
#include <string>

#include "silvasim/base/machine.h"
#include "silvasim/base/progress.h"
#include "silvasim/terminal/terminal.h"
#include "silvavis/commands/diff.h"
#include "silvavis/commands/fly.h"
#include "silvavis/commands/info.h"
#include "silvavis/commands/render.h"
#include "silvavis/commands/view.h"

namespace {

using namespace silvavis::commands;

struct Options {
  RenderOptions render;
  FlyOptions fly;
  ViewOptions view;
  InfoOptions info;
  DiffOptions diff;
};

void add_stage(CLI::App& command, StageOptions& o) {
  command
      .add_option("ecosystem", o.ecosystem,
                  "The ecosystem file (.silva), or a file of details (.details), which then lie on bare, flat land")
      ->required();
  command.add_option("--layers", o.layers, "Only these vegetation layers, separated by commas")->delimiter(',');
  command.add_option("--models", o.models,
                     "Folder in which the models that plants.xml names lie (default: the ecosystem file's)");
  command.add_option("--model", o.model,
                     "A species' model: \"Picea abies=spruce.glb\", or =grown, or =none (may be repeated)");
  command.add_option("--details", o.details,
                     "Ground detail on the land: a file of details that ghosttile filled, or the XML of a scene of "
                     "details, which is filled "
                     "around the eye (may be repeated)");
  command
      .add_option("--details-radius", o.details_radius_m,
                  "Metres around the eye that scenes of details are filled within (default: 40)")
      ->check(CLI::Range(1.0, 1000.0));
  command
      .add_option("--triangles", o.triangles, "Triangles of a grown tree; shrubs and herbs have fewer (default: 40000)")
      ->check(CLI::Range(1000, 2000000));
  command.add_option("--variants", o.variants, "Grown models a species (default: 2)")->check(CLI::Range(1, 64));
  command.add_option("--backend", o.backend, "nested: Silva's trees; embree: one flat structure, for comparison")
      ->check(CLI::IsMember({"nested", "embree"}));
  command
      .add_option("--lod", o.lod,
                  "auto: simpler models where leaves are smaller than a pixel; off: full models everywhere")
      ->check(CLI::IsMember({"auto", "off"}));
  command.add_option(
      "--sun", o.sun,
      "Date and time, like 2026-06-21T10:00 or with Z or +02:00 (default: that, in the place's zone time)");
  command.add_option("--sun-direction", o.sun_direction, "AZIMUTH,ELEVATION of the sun in degrees, instead of a time")
      ->delimiter(',')
      ->expected(2);
  command.add_option("--visibility", o.visibility_km, "How far one sees through the haze, in km (default: 60)")
      ->check(CLI::Range(1.0, 300.0));
  command.add_flag("!--no-surroundings", o.surroundings, "Nothing but a plain around the scene");
  LandOptions& land = o.land;
  command.add_option("--drape", land.drape,
                     "Picture that lies on the land; without a georeference over the whole scene");
  command.add_option("--classes", land.classes, "Raster of classes that colours the land, by its own palette");
  command.add_option("--class-colours", land.class_colours, "Colours of --classes: a CSV of code,class,#rrggbb");
  command.add_flag("--hillshade", land.hillshade, "Plain grey land");
  command.add_option("--water", land.water,
                     "Polygons and lines that mirror: waters.geojson, .gpkg or .shp, with #layer (may be repeated)");
  command.add_option("--water-width", land.water_width_m, "Width of water lines in metres (default: 2)");
  command.add_option("--seed", o.seed, "Of turns, grown plants and samples (default: 1)")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{9007199254740991}));
  command.add_flag("--json", o.common.json, "Print one JSON object instead of text");
  command.add_flag("-q,--quiet", o.common.quiet, "No progress, warnings and summary; only errors");
  command
      .add_option("--threads", o.common.threads,
                  "Threads to use; the result does not depend on it (default: one a core)")
      ->check(CLI::Range(1, 1024));
}

// How a picture is made, for render, fly and view; returns --fov.
CLI::Option* add_picture(CLI::App* command, RenderOptions& o) {
  add_stage(*command, o.stage);
  CLI::Option* fov = command->add_option("--fov", o.fov_deg, "Horizontal angle of view in degrees (default: 50)")
                         ->check(CLI::Range(0.01, 170.0));
  command->add_option("--size", o.size, "WIDTHxHEIGHT in pixels (default: " + o.size + ")");
  command->add_option("--spp", o.samples, "Samples a pixel, at most (default: " + std::to_string(o.samples) + ")")
      ->check(CLI::Range(1, 65536));
  command
      ->add_option("--error", o.error,
                   "A pixel has enough samples below this standard error; 0: all take --spp (default: 0.02)")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--sky-rays", o.sky_rays, "Rays to the sky a sample; 0: the sky casts no shadow (default: 1)")
      ->check(CLI::Range(0, 256));
  command
      ->add_option("--haze", o.haze,
                   "Share of the air's haze before the scene, 0 to 1 (default: 1, less from outside the scene)")
      ->check(CLI::Range(0.0, 1.0));
  command->add_flag("!--no-shadows", o.shadows, "The sun casts no shadow");
  command->add_option("--exposure", o.exposure_stops,
                      "Stops by which the picture is lightened (default: by its brightness)");
  return fov;
}

void add_channels(CLI::App* command, RenderOptions& o) {
  command
      ->add_option(
          "--aov", o.aovs,
          "Also keep depth, normal, species, plant-id (commas); EXR holds them, other pictures put them beside")
      ->delimiter(',')
      ->check(CLI::IsMember({"depth", "normal", "species", "plant-id"}));
}

void add_camera(CLI::App* command, RenderOptions& o, CLI::Option* fov) {
  CLI::Option* camera = command->add_option("--camera", o.camera, "Camera by name: cameras.xml#valley")->excludes(fov);
  command
      ->add_option("--eye", o.eye,
                   "E,N,H of the eye in the scene's metres; +H is above the ground (default: the whole scene)")
      ->excludes(camera);
  command->add_option("--look-at", o.look_at, "E,N,H of the picture's centre")->excludes(camera);
}

void add_render(CLI::App& app, Options& options) {
  RenderOptions& o = options.render;
  CLI::App* command = app.add_subcommand("render", "Render a picture");
  CLI::Option* fov = add_picture(command, o);
  add_channels(command, o);
  command
      ->add_option("-o,--output", o.output, "Picture to write: .exr (linear), .png, .jpg or .tif (as the eye sees it)")
      ->required();
  add_camera(command, o, fov);
  command->callback([&o] { render(o); });
}

void add_fly(CLI::App& app, Options& options) {
  FlyOptions& o = options.fly;
  CLI::App* command = app.add_subcommand("fly", "Render the frames of a flight");
  CLI::Option* fov = add_picture(command, o.picture);
  add_channels(command, o.picture);
  command->add_option("path", o.path, "The flight: .xml, or a line of .geojson")->required();
  command->add_option("-o,--output", o.output, "Frames to write: frames/%04d.png, or .exr, .jpg, .tif")->required();
  command->add_option("--fps", o.fps, "Frames a second (default: the path's, or 25)");
  command->add_option("--speed", o.speed_m_s, "Metres a second (default: by the path's duration, or 20)");
  command->add_option("--duration", o.duration_s, "Seconds of the whole flight, instead of --speed");
  command->add_option("--height-above-ground", o.height_above_ground_m,
                      "Metres above the ground, instead of the heights in a .geojson");
  command->add_option("--look-down", o.look_down_deg,
                      "Degrees below the way ahead, where the path does not say where to look (default: 8)");
  command->add_option("--frames", o.frames, "Only these: 1-250");
  command->add_option("--sun-to", o.sun_to, "The sun moves from --sun to this date and time");
  command->add_flag("--overwrite", o.overwrite, "Make frames anew that are there already");
  command->add_flag("--resume", o.resume, "Make only frames that are not there yet");
  command->callback([&o, fov] {
    o.fov_given = fov->count() > 0;
    fly(o);
  });
}

void add_view(CLI::App& app, Options& options) {
  ViewOptions& o = options.view;
  o.picture.size = "960x540";
  o.picture.samples = 64;
  o.picture.output = "view-%04d.png";
  CLI::App* command = app.add_subcommand("view", "Fly through an ecosystem in a window");
  add_camera(command, o.picture, add_picture(command, o.picture));
  command->add_option("-o,--output", o.picture.output,
                      "Names of what P saves: .png, .exr, .jpg or .tif (default: view-%04d.png)");
  command->add_option("--script", o.script,
                      "Steps to take instead of a user's: lines like \"hold W 20\" and \"press P\"");
  command->add_option("--frames", o.frames, "End after so many pictures, or once the picture is finished")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40));
  command->footer(view_keys);
  command->callback([&o] { view(o); });
}

void add_info(CLI::App& app, Options& options) {
  InfoOptions& o = options.info;
  CLI::App* command = app.add_subcommand("info", "Tell what would be rendered, with which models, and what it takes");
  add_stage(*command, o.stage);
  command->callback([&o] { info(o); });
}

void add_diff(CLI::App& app, Options& options) {
  DiffOptions& o = options.diff;
  CLI::App* command = app.add_subcommand("diff", "Tell how much two pictures differ");
  command->add_option("a", o.a, "A picture")->required();
  command->add_option("b", o.b, "Another of the same size")->required();
  command->add_option("--metric", o.metrics, "Only these, separated by commas")->delimiter(',');
  command->add_option("--threshold", o.threshold, "A pixel differs where a channel does by more (default: 0.01)");
  command->add_option("--at-most", o.at_most, "With one metric: fail where it is worse than this");
  command->add_flag("--json", o.json, "Print one JSON object instead of text");
  command->callback([&o] { diff(o); });
}

}  // namespace

int main(int argc, char** argv) {
  silvasim::base::install_interrupt_handler();
  silvasim::base::give_back_large_blocks();
  CLI::App app("SilvaVis renders the landscapes that silvasim grows.", "silvavis");
  app.set_version_flag("--version", std::string("silvavis ") + SILVA_VERSION);
  app.require_subcommand(1);
  Options options;
  add_render(app, options);
  add_fly(app, options);
  add_view(app, options);
  add_info(app, options);
  add_diff(app, options);
  app.footer("silvavis COMMAND --help tells a command's options.");
  return silvasim::terminal::run("silvavis", "lessen the picture or the models' triangles", [&] {
    try {
      app.parse(argc, argv);
      return 0;
    } catch (const CLI::Success& done) {
      return app.exit(done);
    } catch (const CLI::ParseError& error) {
      throw silvasim::terminal::UsageError(error.what());
    }
  });
}
