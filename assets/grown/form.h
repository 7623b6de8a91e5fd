// What a plant of a species looks like, as numbers: the input of grow().
//
// All lengths within the plant are shares of its height, its crown's radius or the parent branch, so that one form serves
// every size of the species; only leaves have a size in metres. Angles are off the parent's direction: 0 goes on straight.
// Colours are linear reflectances, of the upper side in summer.
//
// Presets: one explicit table (forms.cpp) of genera and species; figures are rounded from general knowledge of the genera
// and tuned by eye. Leaf area indices are those of single crowns (docs/plants.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "assets/vector.h"

namespace assets::grown {

enum class Habit : std::uint8_t {
  woody,  // a stem or several, branches, twigs with sprays of leaves
  fern,   // fronds from one place: rachis and pinnae
  grass,  // blades from one place
  herb,   // leafy stalks with a flower head
};

enum class Leaf : std::uint8_t {
  ovate,       // beech, hornbeam, elm, hazel
  heart,       // lime
  small,       // birch: small, triangular, on long stalks
  lanceolate,  // willow
  lobed,       // oak
  palmate,     // maple, plane, sweetgum
  pinnate,     // ash, rowan, elder, hickory
  comb,        // fir, hemlock, yew: needles left and right of the shoot, flat
  bottle,      // spruce, Douglas fir: needles all around the shoot
  tuft,        // pine: long needles, bundled at the shoot's end
  rosette,     // larch: short needles in rosettes along the shoot
  scales,      // cedars, cypresses, juniper: flat fans of scales
};

enum class Bark : std::uint8_t {
  smooth,    // beech, hornbeam, rowan
  birch,     // white, with dark marks
  fissured,  // oak, ash, willow: long ridges
  plated,    // pine, spruce, sycamore: scales and plates
  stringy,   // cedars, juniper: narrow strips
};

// How the branches of one order stand on their parent. Order 1 stands on the stem.
struct Branches {
  int count = 0;              // on the longest parent of the order before; shorter parents have fewer
  int whorl = 1;              // so many at one place
  float bare_share = 0.1f;    // the inner share of the parent without them (order 1: see crown_base instead)
  float angle_low_deg = 60;   // off the parent, where the branched part begins
  float angle_high_deg = 40;  // and at its end
  float length_low =
      0.6f;  // share of the parent's length, where the branched part begins; order 1: of the crown's room
  float length_high = 0.2f;  // and at its end
  float vary = 0.2f;         // lengths vary by this share
  float planar = 0;          // 0: all around the parent, 1: to its left and right only
  float rise = 0;            // turns up (+) or down (-) along the way: radians in all, in the inner half
  float tip_rise = 0;        // and in the outer half
  float crook = 0.2f;        // radians by which it wanders
  float thick = 0.6f;        // its radius at its foot, at most so much of the parent's there
};

struct Form {
  std::string name;  // of the preset: "beech"
  Habit habit = Habit::woody;

  // Crown: radius at six heights from the crown's base to the top, as shares of the plant's radius.
  float crown_base = 0.35f;  // share of the height below which the stem is bare
  std::array<float, 6> outline{0.4f, 0.9f, 1.0f, 0.9f, 0.65f, 0.1f};
  float ragged = 0.12f;  // the outline wanders by this share around the crown

  // Stems
  int stems = 1;                      // more than one: a shrub, the stems lean outward
  float stem_lean_deg = 2;            // of many stems: the outermost's lean
  float stem_radius_share = 0.0095f;  // radius at the foot, of the height
  float leader = 1.0f;                // share of the height above which the stem is but one of the branches
  float stem_crook = 0.05f;           // radians by which the stem wanders
  float flare = 0.5f;                 // the foot is so much wider
  float tip_droop = 0;                // the leader hangs over (hemlock): radians

  std::array<Branches, 3> branches{};
  int orders = 3;  // how many of them are there, 1 to 3

  // Foliage
  Leaf leaf = Leaf::ovate;
  float few_cards_area = 1;     // share of the leaf area that is kept at 5,000 triangles, so that the silhouette stays
  float leaf_length_m = 0.08f;  // leaf, or needle; compound leaves as a whole
  float leaf_width_share = 0.6f;
  float leaf_area_index = 5;   // one-sided leaf area over the crown's projection, pi radius^2
  float leafed_share = 0.8f;   // outer share of the last order's branches that bears leaves
  float inner_leaves = 0.35f;  // outer share of the other branches that bears leaves
  float spray_angle_deg = 45;  // sprays off the twig
  float spray_hang = 0;        // 0: as the twig goes, 1: straight down; negative: up
  float tumble = 0.5f;         // 0: sprays lie flat, 1: they face anywhere
  Rgb leaf_colour{0.069f, 0.132f, 0.044f};
  float leaf_vary = 0.25f;               // leaves differ in brightness by this share
  Rgb leaf_passes{0.75f, 0.90f, 0.35f};  // transmittance as a share of reflectance
  int flowers = 0;                       // heads of flowers or fruit at the ends of outer twigs
  float flower_size_m = 0.12f;
  Rgb flower_colour{0.5f, 0.5f, 0.4f};

  // Wood
  Bark bark = Bark::smooth;
  Rgb bark_colour{0.16f, 0.15f, 0.13f};        // of the stem, mean
  Rgb bark_upper_colour{0.16f, 0.15f, 0.13f};  // above bark_upper_share of the height, and on the branches
  float bark_upper_share = 1.0f;
  Rgb twig_colour{0.09f, 0.07f, 0.05f};
};

// How a plant of that name and size looks. Known are the genera and species of known_names(), also as the first word of a
// longer name, in Latin or English, whatever the case ("Quercus petraea", "oak"). Other names: a shrub below 6 m, a low
// herb below 0.6 m, otherwise a conifer where it is eight times as high as wide, otherwise a broadleaf.
// `known` (where given) tells whether the name was found.
Form form_of(const std::string& scientific_name, double height_m, double radius_m, bool* known = nullptr);

// The names in the table: genera, species, English words.
std::vector<std::string> known_names();

// The forms themselves, one of each, in the order of docs/plants.md.
std::vector<Form> all_forms();

}  // namespace assets::grown
