#include "silvavis/flora.h"

#include <algorithm>
#include <atomic>
#include <climits>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "assets/fit.h"
#include "assets/grown/grow.h"
#include "assets/load.h"
#include "silvasim/base/error.h"
#include "silvasim/base/machine.h"
#include "silvasim/base/parallel.h"
#include "silvavis/accel/pack.h"
#include "silvavis/impostor_of.h"
#include "silvavis/level_light.h"
#include "silvavis/levels/thin.h"
#include "silvavis/scene/instance.h"

namespace silvavis {

namespace {

namespace ecosystem = silvasim::ecosystem;

struct Task {
  std::size_t layer = 0, species = 0;
  int variant = 0;
  std::optional<std::filesystem::path> file;  // none: grown
};

// A shrub of a metre shows no more than a tree of thirty: triangles go with the height's root.
int triangles_for(const FloraOptions& options, double height_m) {
  const double share = std::clamp(std::sqrt(height_m / 25.0), 0.1, 1.0);
  return std::max(1000, static_cast<int>(options.triangles * share));
}

assets::Model model_for(const Task& task, const ecosystem::Species& species, const FloraOptions& options,
                        std::vector<std::string>& warnings) {
  const auto height = static_cast<double>(species.height_m), radius = static_cast<double>(species.model_radius_m);
  if (task.file) {
    assets::LoadReport report;
    assets::Model model = assets::fitted(assets::load(*task.file, {}, &report), {height, radius}, &report);
    warnings.insert(warnings.end(), report.warnings.begin(), report.warnings.end());
    return model;
  }
  const auto seed = options.seed * 1000003 + static_cast<std::uint64_t>(task.variant);
  return assets::grown::grow(assets::grown::form_of(species.name, height, radius), height, radius, seed,
                             {triangles_for(options, height)});
}

// One at a time: for 160,000 triangles it takes 25 MB beside the model. Nothing inside waits for other threads.
levels::Thinned thinned_alone(const assets::Model& model, double share) {
  static std::mutex alone;
  const std::lock_guard lock(alone);
  return levels::thinned(model, share);
}

// The model and its simpler levels, each an eighth of the one before, as long as there is something to simplify.
std::shared_ptr<const scene::PlantModel> packed_with_levels(const assets::Model& model, bool levels) {
  auto full = std::make_shared<scene::PlantModel>(accel::pack(model));
  full->leaf_m = levels::leaf_size(model);
  if (!levels) return full;
  const auto impostor = std::make_shared<const scene::Impostor>(impostor_of(*full));
  std::optional<double> brightness;
  std::vector<std::shared_ptr<const scene::PlantModel>> coarser;
  for (double share = 1.0 / 8; static_cast<double>(model.triangles.size()) * share > 60; share /= 8) {
    const auto leaf_m = full->leaf_m * static_cast<float>(0.7 / std::sqrt(share));
    if (leaf_m > scene::texels_a_pixel * impostor->texel_m) break;
    const levels::Thinned simpler = thinned_alone(model, share);
    // Wood alone may vanish.
    if (simpler.model.triangles.size() < 8) break;
    auto level = std::make_shared<scene::PlantModel>(accel::pack(simpler.model, full->looks));
    level->leaf_m = std::max(full->leaf_m * simpler.enlarged, leaf_m);
    if (!brightness) brightness = lit_brightness(full);
    const double own = lit_brightness(level);
    if (own > 0) level->tint = static_cast<float>(std::clamp(*brightness / own, 0.5, 2.0));
    coarser.push_back(std::move(level));
  }
  full->coarser = std::move(coarser);
  full->impostor = impostor;
  return full;
}

}  // namespace

Flora models_of(const ecosystem::Ecosystem& from, const FloraOptions& options,
                const silvasim::base::Progress& progress) {
  Flora flora;
  std::vector<Task> tasks;
  for (const auto& [name, model] : options.overrides) {
    const bool known = std::any_of(from.layers.begin(), from.layers.end(), [&](const ecosystem::Layer& layer) {
      return std::any_of(layer.species.begin(), layer.species.end(),
                         [&](const auto& species) { return species.name == name; });
    });
    if (!known) throw silvasim::base::Error("there is no species \"" + name + "\" to give the model \"" + model + "\"");
  }
  for (std::size_t k = 0; k < from.layers.size(); ++k) {
    const ecosystem::Layer& layer = from.layers[k];
    flora.models.emplace_back(layer.species.size());
    flora.sources.emplace_back(layer.species.size());
    if (!options.layers.empty() &&
        std::find(options.layers.begin(), options.layers.end(), layer.name) == options.layers.end())
      continue;
    const std::vector<std::uint64_t> counts = ecosystem::plants_by_species(layer);
    for (std::size_t s = 0; s < layer.species.size(); ++s) {
      if (counts[s] == 0) continue;
      const ecosystem::Species& species = layer.species[s];
      const auto override = options.overrides.find(species.name);
      const std::string named = override != options.overrides.end() ? override->second : species.model;
      if (named == "none") continue;
      Task task{k, s, 0, {}};
      if (!named.empty() && named != "grown") {
        const std::filesystem::path file =
            override != options.overrides.end() ? std::filesystem::path(named) : options.folder / named;
        if (std::filesystem::exists(file) || override != options.overrides.end()) {
          task.file = file;
        } else {
          flora.warnings.push_back(
              "model \"" + file.string() + "\" of species \"" + species.name +
              "\" is missing; a grown plant stands in for it (--models FOLDER says where models lie)");
        }
      }
      flora.sources[k][s] = task.file ? task.file->string() : "grown";
      const int variants = task.file ? 1 : std::max(1, options.variants);
      flora.models[k][s].resize(static_cast<std::size_t>(variants));
      for (int v = 0; v < variants; ++v) {
        task.variant = v;
        tasks.push_back(task);
      }
    }
  }
  for (const std::string& name : options.layers) {
    if (std::none_of(from.layers.begin(), from.layers.end(), [&](const auto& layer) { return layer.name == name; }))
      throw silvasim::base::Error("there is no layer \"" + name + "\"");
  }

  // The greatest first, one after another: so no thread is left with some when the others are through.
  const auto size_of = [&](const Task& task) {
    const ecosystem::Species& species = from.layers[task.layer].species[task.species];
    return task.file ? INT_MAX : triangles_for(options, static_cast<double>(species.height_m));
  };
  std::stable_sort(tasks.begin(), tasks.end(), [&](const Task& a, const Task& b) { return size_of(a) > size_of(b); });

  std::vector<std::vector<std::string>> warnings(tasks.size());
  std::atomic<std::size_t> next = 0, done = 0;
  silvasim::base::parallel_for(tasks.size(), [&](std::size_t) {
    const std::size_t i = next++;
    const Task& task = tasks[i];
    flora.models[task.layer][task.species][static_cast<std::size_t>(task.variant)] = packed_with_levels(
        model_for(task, from.layers[task.layer].species[task.species], options, warnings[i]), options.levels);
    silvasim::base::give_back_free_memory();
    silvasim::base::report(progress, "models", static_cast<double>(++done) / static_cast<double>(tasks.size()));
  });
  for (const auto& of_task : warnings) flora.warnings.insert(flora.warnings.end(), of_task.begin(), of_task.end());
  return flora;
}

}  // namespace silvavis
