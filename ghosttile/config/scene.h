// A scene of details: its XML, the Ghost Tile and the land that it names, and the plan to fill that land by.
//
// Errors: base::ConfigError with every finding in the XML; base::Error where a file cannot be read.
// Threads: plan() from one thread; what it returns from any. The scene must outlive its plans' fields.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ghosttile/config/density_xml.h"
#include "ghosttile/fill/plan.h"
#include "silvasim/base/geometry.h"
#include "silvasim/base/progress.h"

namespace ghosttile::config {

class Scene {
 public:
  explicit Scene(const std::filesystem::path& file, const silvasim::base::Progress& progress = {});
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  const std::shared_ptr<const tile::GhostTile>& tile() const { return tile_; }
  // A Ghost Tile that was loaded before stands in for the one that the XML names; it must be of the same objects.
  void use_tile(std::shared_ptr<const tile::GhostTile> tile);

  // The land's box, empty where there is no ecosystem.
  const silvasim::base::Box& land() const { return land_box_; }
  const std::vector<std::filesystem::path>& inputs() const { return inputs_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  // Of the XML and of the files that it names itself; not of rasters that the fields' XML names.
  const std::string& sha256() const { return sha256_; }
  std::string crs_wkt() const;

  // What to fill, within `region` at least. `edits`: texts of <strokes>, in their order.
  fill::Plan plan(const density::Box3& region, const std::vector<std::string>& edits = {}) const;

  // The box that the strokes change. Errors: base::ConfigError also where it has no bounds. `name` stands in messages.
  density::Box3 touched_by(const std::string& strokes, const std::string& name) const;

 private:
  struct Parts;
  void read_land(const silvasim::base::Progress& progress);
  Surroundings around(const density::Box3& region) const;

  std::unique_ptr<Parts> parts_;
  std::shared_ptr<const tile::GhostTile> tile_;
  silvasim::base::Box land_box_;
  std::vector<std::filesystem::path> inputs_;
  std::vector<std::string> warnings_;
  std::string sha256_;
};

// Everywhere.
density::Box3 everywhere();

}  // namespace ghosttile::config
