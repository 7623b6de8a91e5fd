#include "assets/finish.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "assets/colour_materials.h"
#include "assets/leaf.h"
#include "assets/normals.h"
#include "silvasim/base/error.h"
#include "silvasim/base/words.h"

namespace assets {

namespace {

constexpr float most_coordinate_m = 1e7f;
constexpr std::size_t most_materials = 65535;

bool usable(const Rgb& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

Rgb within_unit(const Rgb& c) {
  return {std::clamp(c.x, 0.0f, 1.0f), std::clamp(c.y, 0.0f, 1.0f), std::clamp(c.z, 0.0f, 1.0f)};
}

void check(const Draft& draft, Reading& reading) {
  if (draft.triangles.empty()) reading.fail("it has no triangles");
  reading.check_triangles(draft.triangles.size());
  if (draft.positions.size() > 0xFFFFFFF0u) reading.fail("it has too many vertices");
  for (const auto& triangle : draft.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= draft.positions.size()) {
        reading.fail("a triangle uses vertex " + std::to_string(corner) + " of " +
                     std::to_string(draft.positions.size()));
      }
      const V3& p = draft.positions[corner];
      for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(p[axis]) <= most_coordinate_m)) {
          reading.fail("vertex " + std::to_string(corner) + " is no number or lies farther than 10,000 km away");
        }
      }
    }
  }
  for (const DraftMaterial& m : draft.materials) {
    if (!usable(m.colour) || !usable(m.transmission) || !std::isfinite(m.alpha) || !std::isfinite(m.cutoff)) {
      reading.fail("material \"" + m.name + "\" has a colour that is no number");
    }
  }
}

struct Finished {
  Material material;
  bool invisible = false;
};

// Two materials that name one file share its texture.
std::string identity(const Picture* picture) {
  if (picture == nullptr) return {};
  if (!picture->file.empty()) return picture->file.string();
  return "in memory " + std::to_string(reinterpret_cast<std::uintptr_t>(picture));
}

class Materials {
 public:
  Materials(Reading& reading, Model& model) : reading_(reading), model_(model) {}

  Finished finish(const DraftMaterial& draft);

 private:
  struct Loaded {
    int texture = no_texture;
    Rgb mean{1.0f, 1.0f, 1.0f};
    double covered = 1;
  };

  Loaded load(const DraftMaterial& draft, float cutoff);
  const Texture& texture(const Loaded& loaded) const {
    return model_.textures[static_cast<std::size_t>(loaded.texture)];
  }

  Reading& reading_;
  Model& model_;
  std::map<std::tuple<std::string, std::string, float>, Loaded> loaded_;
};

Materials::Loaded Materials::load(const DraftMaterial& draft, float cutoff) {
  static const Picture white{"white", {}, {}};
  const Picture* colour = draft.colour_picture ? draft.colour_picture.get() : &white;
  const auto key = std::make_tuple(identity(colour), identity(draft.alpha_picture.get()), cutoff);
  if (const auto it = loaded_.find(key); it != loaded_.end()) return it->second;
  Loaded result;
  try {
    Texture texture = load_texture(*colour, draft.alpha_picture.get(), {reading_.options.most_texture_px, cutoff});
    result.mean = mean_colour(texture, cutoff);
    result.covered = coverage(texture, cutoff);
    result.texture = static_cast<int>(model_.textures.size());
    model_.textures.push_back(std::move(texture));
  } catch (const silvasim::base::Error& error) {
    reading_.warn(std::string(error.what()) + "; the material gets a plain colour");
  }
  loaded_.emplace(key, result);
  return result;
}

Finished Materials::finish(const DraftMaterial& draft) {
  Finished result;
  Material& material = result.material;
  material.name = silvasim::base::shortened(draft.name, 200);
  material.two_sided = draft.two_sided;
  Rgb colour = within_unit(draft.colour);
  const float alpha = std::clamp(draft.alpha, 0.0f, 1.0f);

  // The test "texture alpha * factor >= cutoff" is "texture alpha >= cutoff / factor".
  float cutoff = 0;
  if (draft.alpha_mode == Alpha::cut) cutoff = draft.cutoff;
  if (draft.alpha_mode == Alpha::blend || draft.alpha_mode == Alpha::by_texture) cutoff = 0.5f;
  const bool has_picture = draft.colour_picture != nullptr || draft.alpha_picture != nullptr;
  if (draft.alpha_mode == Alpha::cut && cutoff > 0 && alpha < 1) {
    cutoff = alpha > 0 ? cutoff / alpha : 2.0f;
    if (cutoff > 1) {
      result.invisible = true;
      return result;
    }
  }
  cutoff = std::clamp(cutoff, 0.0f, 1.0f);

  Loaded loaded;
  if (has_picture) {
    loaded = load(draft, cutoff);
    // A picture that is full or empty of alpha was not meant as a stencil where the file does not say so.
    const bool stencil = loaded.covered <= 0.98 && loaded.covered >= 0.02;
    if (draft.alpha_mode == Alpha::by_texture && loaded.texture != no_texture && texture(loaded).has_alpha &&
        !stencil) {
      cutoff = 0;
      loaded = load(draft, cutoff);
    }
  }
  const bool lost = loaded.texture == no_texture && (has_picture || draft.picture_lost);
  material.texture = loaded.texture;
  const bool has_alpha = loaded.texture != no_texture && texture(loaded).has_alpha;
  material.alpha_cutoff = has_alpha ? cutoff : 0.0f;

  const std::string names = draft.name + " " + (draft.colour_picture ? draft.colour_picture->name : "");
  const Rgb seen = colour * loaded.mean;
  const Foliage kind = foliage({names, material.alpha_cutoff > 0, draft.two_sided, seen});
  // Files with a picture leave the colour white, which no plant is.
  if (lost && std::min({colour.x, colour.y, colour.z}) > 0.7f) {
    colour = kind != Foliage::none ? Rgb(0.09f, 0.16f, 0.04f) : Rgb(0.2f, 0.16f, 0.12f);
  }

  if (draft.alpha_mode == Alpha::cut && kind != Foliage::none && loaded.texture != no_texture && !has_alpha) {
    reading_.warn("material \"" + draft.name + "\" is to be cut out by its texture's alpha, which has none");
  }
  const LeafColour leaf = leaf_colour(kind, colour, loaded.mean);
  material.reflectance = leaf.reflectance;
  material.transmittance = leaf.transmittance;
  // What the file itself says of light that passes goes before the guess.
  Rgb passes = within_unit(draft.transmission);
  if (draft.alpha_mode == Alpha::blend && !has_picture) passes = passes + Rgb(1.0f - alpha) * (Rgb(1.0f) - passes);
  if (std::max({passes.x, passes.y, passes.z}) > 0) {
    material.transmittance = colour * passes;
    material.reflectance = colour * (Rgb(1.0f) - passes);
  }
  return result;
}

// Keeps the triangles that have an area and are seen.
void drop_triangles(Draft& draft, const std::vector<bool>& invisible) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < draft.triangles.size(); ++i) {
    const auto [a, b, c] = draft.triangles[i];
    if (invisible[draft.triangle_materials[i]]) continue;
    if (!has_area(draft.positions[a], draft.positions[b], draft.positions[c])) continue;
    draft.triangles[kept] = draft.triangles[i];
    draft.triangle_materials[kept++] = draft.triangle_materials[i];
  }
  draft.triangles.resize(kept);
  draft.triangle_materials.resize(kept);
}

// Drops textures that no material came to use (read to see what their alpha means).
void drop_textures(Model& model) {
  std::vector<int> number(model.textures.size(), no_texture);
  std::vector<Texture> kept;
  for (Material& material : model.materials) {
    if (material.texture == no_texture) continue;
    int& to = number[static_cast<std::size_t>(material.texture)];
    if (to == no_texture) {
      to = static_cast<int>(kept.size());
      kept.push_back(std::move(model.textures[static_cast<std::size_t>(material.texture)]));
    }
    material.texture = to;
  }
  model.textures = std::move(kept);
}

// Numbers the vertices anew, by first use.
void compact(Model& model) {
  constexpr std::uint32_t unused = 0xFFFFFFFFu;
  std::vector<std::uint32_t> number(model.positions.size(), unused);
  Model kept;
  for (auto& triangle : model.triangles) {
    for (std::uint32_t& corner : triangle) {
      if (number[corner] == unused) {
        number[corner] = static_cast<std::uint32_t>(kept.positions.size());
        kept.positions.push_back(model.positions[corner]);
        kept.normals.push_back(model.normals[corner]);
        kept.uvs.push_back(model.uvs[corner]);
      }
      corner = number[corner];
    }
  }
  model.positions = std::move(kept.positions);
  model.normals = std::move(kept.normals);
  model.uvs = std::move(kept.uvs);
}

// Texture coordinates of textured triangles must be numbers; others are zero.
void clean_uvs(Model& model, Reading& reading) {
  std::vector<bool> textured(model.uvs.size(), false);
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    if (model.materials[model.triangle_materials[i]].texture == no_texture) continue;
    for (const std::uint32_t corner : model.triangles[i]) textured[corner] = true;
  }
  constexpr float most = 1e6f;
  std::size_t bad = 0;
  for (std::size_t i = 0; i < model.uvs.size(); ++i) {
    V2& uv = model.uvs[i];
    const bool good = std::abs(uv.x) <= most && std::abs(uv.y) <= most;
    if (textured[i] && !good) ++bad;
    if (!textured[i] || !good) uv = V2(0.0f, 0.0f);
  }
  if (bad > 0)
    reading.warn(std::to_string(bad) + " texture coordinates are no numbers or beyond a million; they became 0");
}

}  // namespace

Model finished(Draft draft, Reading& reading) {
  check(draft, reading);
  if (draft.materials.empty()) {
    draft.materials.emplace_back();
    draft.triangle_materials.assign(draft.triangles.size(), 0);
  }
  for (const std::uint32_t material : draft.triangle_materials) {
    if (material >= draft.materials.size())
      reading.fail("a triangle uses material " + std::to_string(material) + " of " +
                   std::to_string(draft.materials.size()));
  }

  Model model;
  Materials materials(reading, model);
  std::vector<bool> invisible(draft.materials.size(), false), used(draft.materials.size(), false);
  for (const std::uint32_t material : draft.triangle_materials) used[material] = true;

  // Materials that nothing uses are left out, so that their textures are not read.
  std::vector<std::uint32_t> number(draft.materials.size(), 0);
  for (std::size_t i = 0; i < draft.materials.size(); ++i) {
    if (!used[i]) continue;
    Finished one = materials.finish(draft.materials[i]);
    if (one.invisible) {
      invisible[i] = true;
      reading.warn("material \"" + one.material.name + "\" is fully transparent; its triangles are left out");
      continue;
    }
    number[i] = static_cast<std::uint32_t>(model.materials.size());
    model.materials.push_back(std::move(one.material));
  }
  drop_triangles(draft, invisible);
  if (draft.triangles.empty()) reading.fail("none of its triangles has an area that can be seen");
  for (std::uint32_t& material : draft.triangle_materials) material = number[material];

  if (!draft.colours.empty()) fold_colours(draft, model.materials);
  if (model.materials.size() > most_materials) {
    reading.fail("it has " + std::to_string(model.materials.size()) + " materials, at most " +
                 std::to_string(most_materials) + " are allowed");
  }

  const std::size_t mended = make_normals(draft);
  if (mended > 0) reading.warn(std::to_string(mended) + " normals have no direction; they were made anew");
  model.positions = std::move(draft.positions);
  model.normals = std::move(draft.normals);
  model.uvs = std::move(draft.uvs);
  model.triangles = std::move(draft.triangles);
  model.triangle_materials.assign(draft.triangle_materials.begin(), draft.triangle_materials.end());
  face_normals(model);
  clean_uvs(model, reading);
  drop_textures(model);
  compact(model);
  return model;
}

}  // namespace assets
