#include "assets/grown/presets.h"

namespace assets::grown::presets {

// Many stems from one stool.
Form shrub() {
  Form f;
  f.name = "shrub";
  f.crown_base = 0.12f;
  f.outline = {0.55f, 0.85f, 1.0f, 0.97f, 0.8f, 0.3f};
  f.ragged = 0.2f;
  f.stems = 9;
  f.stem_lean_deg = 32;
  f.stem_radius_share = 0.0075f;
  f.stem_crook = 0.3f;
  f.flare = 0.15f;
  f.branches[0] = {.count = 13,
                   .angle_low_deg = 50,
                   .angle_high_deg = 35,
                   .length_low = 0.75f,
                   .length_high = 0.8f,
                   .vary = 0.35f,
                   .rise = 0.2f,
                   .tip_rise = 0.1f,
                   .crook = 0.4f,
                   .thick = 0.6f};
  f.branches[1] = {.count = 12,
                   .bare_share = 0.15f,
                   .angle_low_deg = 50,
                   .angle_high_deg = 40,
                   .length_low = 0.5f,
                   .length_high = 0.25f,
                   .planar = 0.3f,
                   .crook = 0.4f};
  f.branches[2] = {.count = 6,
                   .bare_share = 0.1f,
                   .angle_low_deg = 50,
                   .angle_high_deg = 40,
                   .length_low = 0.5f,
                   .length_high = 0.3f,
                   .planar = 0.4f,
                   .crook = 0.3f};
  f.orders = 2;
  f.leaf_area_index = 5;
  f.leaf_length_m = 0.06f;
  f.bark_colour = f.bark_upper_colour = {0.17f, 0.15f, 0.12f};
  return f;
}

// Long rods that lean outward, large round leaves.
Form hazel() {
  Form f = shrub();
  f.name = "hazel";
  f.stems = 14;
  f.stem_lean_deg = 30;
  f.outline = {0.4f, 0.7f, 0.92f, 1.0f, 0.85f, 0.4f};
  f.leaf_length_m = 0.1f;
  f.leaf_width_share = 0.85f;
  f.leaf_area_index = 5.2f;
  f.tumble = 0.3f;
  f.leaf_colour = {0.071f, 0.137f, 0.045f};
  f.bark_colour = f.bark_upper_colour = {0.18f, 0.145f, 0.105f};
  return f;
}

// Short stem, dense crooked thorny crown, white flowers.
Form hawthorn() {
  Form f = shrub();
  f.name = "hawthorn";
  f.orders = 3;
  f.few_cards_area = 0.95f;
  f.stems = 3;
  f.stem_lean_deg = 16;
  f.stem_radius_share = 0.011f;
  f.stem_crook = 0.5f;
  f.crown_base = 0.16f;
  f.outline = {0.6f, 0.95f, 1.0f, 0.9f, 0.7f, 0.25f};
  f.branches[0].count = 20;
  f.branches[0].angle_low_deg = 70;
  f.branches[0].crook = 0.8f;
  f.branches[1].crook = 0.7f;
  f.branches[1].count = 14;
  f.leaf = Leaf::lobed;
  f.leaf_length_m = 0.045f;
  f.leaf_width_share = 0.8f;
  f.leaf_area_index = 6;
  f.tumble = 0.8f;
  f.leaf_colour = {0.052f, 0.100f, 0.033f};
  f.bark = Bark::fissured;
  f.bark_colour = f.bark_upper_colour = {0.17f, 0.145f, 0.12f};
  return f;
}

// Arching stems, feathered leaves, flat white flower heads.
Form elder() {
  Form f = shrub();
  f.name = "elder";
  f.stems = 7;
  f.stem_lean_deg = 34;
  f.stem_radius_share = 0.009f;
  f.leaf = Leaf::pinnate;
  f.leaf_length_m = 0.2f;
  f.leaf_area_index = 4.8f;
  f.tumble = 0.4f;
  f.leaf_colour = {0.063f, 0.122f, 0.040f};
  f.flowers = 140;
  f.flower_size_m = 0.16f;
  f.flower_colour = {0.62f, 0.60f, 0.46f};
  f.bark = Bark::fissured;
  f.bark_colour = f.bark_upper_colour = {0.22f, 0.20f, 0.165f};
  return f;
}

Form red_elder() {
  Form f = elder();
  f.name = "red elder";
  f.few_cards_area = 1.06f;
  f.stems = 9;
  f.leaf_colour = {0.069f, 0.132f, 0.044f};
  f.flowers = 120;
  f.flower_size_m = 0.08f;
  f.flower_colour = {0.40f, 0.03f, 0.02f};
  return f;
}

Form buckthorn() {
  Form f = shrub();
  f.name = "buckthorn";
  f.stems = 5;
  f.stem_lean_deg = 20;
  f.leaf_length_m = 0.05f;
  f.leaf_width_share = 0.6f;
  f.leaf_area_index = 3.8f;
  f.leaf_colour = {0.062f, 0.120f, 0.040f};
  f.bark_colour = f.bark_upper_colour = {0.12f, 0.11f, 0.095f};
  return f;
}

Form shrub_willow() {
  Form f = shrub();
  f.name = "shrub willow";
  f.few_cards_area = 1.08f;
  f.stems = 16;
  f.stem_lean_deg = 42;
  f.outline = {0.75f, 0.95f, 1.0f, 0.92f, 0.72f, 0.25f};
  f.leaf = Leaf::lanceolate;
  f.leaf_length_m = 0.07f;
  f.leaf_width_share = 0.38f;
  f.leaf_area_index = 4.8f;
  f.tumble = 0.7f;
  f.leaf_colour = {0.090f, 0.144f, 0.068f};
  f.leaf_passes = {0.6f, 0.75f, 0.4f};
  return f;
}

Form fern() {
  Form f;
  f.name = "fern";
  f.habit = Habit::fern;
  f.leaf_area_index = 2.8f;
  f.leaf_colour = {0.073f, 0.140f, 0.046f};
  return f;
}

Form grass() {
  Form f;
  f.name = "grass";
  f.habit = Habit::grass;
  f.leaf_area_index = 2.8f;
  f.leaf_colour = {0.091f, 0.156f, 0.051f};
  return f;
}

Form herb() {
  Form f = shrub();
  f.name = "herb";
  f.habit = Habit::herb;
  f.crown_base = 0.08f;
  f.outline = {0.6f, 0.85f, 0.95f, 1.0f, 0.95f, 0.8f};
  f.stems = 16;
  f.stem_lean_deg = 26;
  f.stem_radius_share = 0.006f;
  f.branches[0] = {.count = 7,
                   .angle_low_deg = 45,
                   .angle_high_deg = 30,
                   .length_low = 0.5f,
                   .length_high = 0.15f,
                   .rise = 0.2f,
                   .crook = 0.2f};
  f.orders = 1;
  f.leaf = Leaf::lanceolate;
  f.leaf_length_m = 0.07f;
  f.leaf_width_share = 0.3f;
  f.leaf_area_index = 2.2f;
  f.tumble = 0.5f;
  f.leaf_colour = {0.073f, 0.140f, 0.046f};
  f.flowers = 16;
  f.flower_size_m = 0.08f;
  f.flower_colour = {0.60f, 0.56f, 0.58f};
  f.bark_colour = f.bark_upper_colour = f.twig_colour = {0.085f, 0.12f, 0.045f};
  return f;
}

}  // namespace assets::grown::presets
