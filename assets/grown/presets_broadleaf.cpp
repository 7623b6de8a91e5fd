#include "assets/grown/presets.h"

namespace assets::grown::presets {

// Grown in a stand: a clear lower stem, the crown's widest place above its middle.
Form broadleaf() {
  Form f;
  f.name = "broadleaf";
  f.crown_base = 0.30f;
  f.outline = {0.45f, 0.9f, 1.0f, 0.95f, 0.75f, 0.4f};
  f.leader = 0.6f;
  f.stem_crook = 0.15f;
  f.branches[0] = {.count = 56,
                   .angle_low_deg = 68,
                   .angle_high_deg = 28,
                   .length_low = 0.95f,
                   .length_high = 0.95f,
                   .vary = 0.25f,
                   .rise = 0.25f,
                   .tip_rise = 0.2f,
                   .crook = 0.35f,
                   .thick = 0.5f};
  f.branches[1] = {.count = 16,
                   .bare_share = 0.22f,
                   .angle_low_deg = 55,
                   .angle_high_deg = 38,
                   .length_low = 0.5f,
                   .length_high = 0.25f,
                   .planar = 0.35f,
                   .rise = 0.15f,
                   .tip_rise = 0.1f,
                   .crook = 0.4f};
  f.branches[2] = {.count = 9,
                   .bare_share = 0.15f,
                   .angle_low_deg = 55,
                   .angle_high_deg = 40,
                   .length_low = 0.5f,
                   .length_high = 0.3f,
                   .planar = 0.5f,
                   .crook = 0.35f};
  return f;
}

Form beech() {
  Form f = broadleaf();
  f.name = "beech";
  f.few_cards_area = 1.16f;
  f.outline = {0.4f, 0.85f, 1.0f, 0.97f, 0.78f, 0.45f};
  f.branches[0].count = 60;
  f.branches[1].planar = 0.8f;
  f.branches[2].planar = 0.9f;
  f.leaf_length_m = 0.075f;
  f.leaf_width_share = 0.62f;
  f.leaf_area_index = 8.4f;
  f.tumble = 0.3f;
  f.leaf_colour = {0.070f, 0.134f, 0.044f};
  f.bark_colour = f.bark_upper_colour = {0.21f, 0.21f, 0.19f};
  f.twig_colour = {0.10f, 0.085f, 0.07f};
  return f;
}

Form oak() {
  Form f = broadleaf();
  f.name = "oak";
  f.crown_base = 0.26f;
  f.outline = {0.6f, 0.97f, 1.0f, 0.93f, 0.72f, 0.5f};
  f.ragged = 0.2f;
  f.leader = 0.45f;
  f.stem_radius_share = 0.012f;
  f.stem_crook = 0.28f;
  f.branches[0] = {.count = 32,
                   .angle_low_deg = 78,
                   .angle_high_deg = 35,
                   .length_low = 1.0f,
                   .length_high = 0.95f,
                   .vary = 0.25f,
                   .rise = 0.2f,
                   .tip_rise = 0.3f,
                   .crook = 0.75f,
                   .thick = 0.62f};
  f.branches[1] = {.count = 17,
                   .bare_share = 0.3f,
                   .angle_low_deg = 60,
                   .angle_high_deg = 45,
                   .length_low = 0.5f,
                   .length_high = 0.32f,
                   .vary = 0.35f,
                   .planar = 0.1f,
                   .rise = 0.25f,
                   .tip_rise = 0.15f,
                   .crook = 0.7f};
  f.branches[2].count = 12;
  f.branches[2].planar = 0.1f;
  f.branches[2].crook = 0.6f;
  f.leaf = Leaf::lobed;
  f.leaf_length_m = 0.1f;
  f.leaf_width_share = 0.6f;
  f.leaf_area_index = 6.4f;
  f.tumble = 0.7f;
  f.leaf_colour = {0.058f, 0.112f, 0.037f};
  f.bark = Bark::fissured;
  f.bark_colour = f.bark_upper_colour = {0.15f, 0.13f, 0.105f};
  return f;
}

Form red_oak() {
  Form f = oak();
  f.name = "red oak";
  f.few_cards_area = 1.07f;
  f.crown_base = 0.32f;
  f.leader = 0.55f;
  f.branches[0].crook = 0.45f;
  f.branches[0].count = 40;
  f.branches[0].rise = 0.3f;
  f.leaf_length_m = 0.16f;
  f.leaf_colour = {0.063f, 0.122f, 0.040f};
  f.bark_colour = f.bark_upper_colour = {0.15f, 0.14f, 0.125f};
  return f;
}

Form maple() {
  Form f = broadleaf();
  f.name = "maple";
  f.few_cards_area = 1.05f;
  f.crown_base = 0.28f;
  f.outline = {0.5f, 0.92f, 1.0f, 0.95f, 0.75f, 0.5f};
  f.ragged = 0.16f;
  f.branches[0].angle_low_deg = 60;
  f.branches[0].rise = 0.4f;
  f.leaf = Leaf::palmate;
  f.leaf_length_m = 0.14f;
  f.leaf_area_index = 7.3f;
  f.tumble = 0.35f;
  f.leaf_colour = {0.069f, 0.132f, 0.044f};
  f.bark = Bark::plated;
  f.bark_colour = f.bark_upper_colour = {0.20f, 0.18f, 0.155f};
  return f;
}

Form ash() {
  Form f = broadleaf();
  f.name = "ash";
  f.few_cards_area = 1.12f;
  f.crown_base = 0.36f;
  f.outline = {0.4f, 0.8f, 1.0f, 0.98f, 0.8f, 0.5f};
  f.ragged = 0.2f;
  f.branches[0].count = 38;
  f.branches[0].angle_low_deg = 52;
  f.branches[0].rise = 0.35f;
  f.branches[1].count = 12;
  f.branches[2].count = 7;
  f.leaf = Leaf::pinnate;
  f.leaf_length_m = 0.25f;
  f.leaf_area_index = 4.6f;
  f.inner_leaves = 0.2f;
  f.leafed_share = 0.6f;
  f.tumble = 0.5f;
  f.leaf_colour = {0.076f, 0.146f, 0.048f};
  f.bark = Bark::fissured;
  f.bark_colour = f.bark_upper_colour = {0.22f, 0.21f, 0.18f};
  return f;
}

Form hickory() {
  Form f = ash();
  f.name = "hickory";
  f.few_cards_area = 1.14f;
  f.outline = {0.4f, 0.8f, 1.0f, 0.95f, 0.75f, 0.45f};
  f.leader = 0.75f;
  f.leaf_area_index = 6.3f;
  f.leaf_colour = {0.076f, 0.140f, 0.046f};
  f.bark_colour = f.bark_upper_colour = {0.17f, 0.155f, 0.14f};
  return f;
}

Form lime() {
  Form f = broadleaf();
  f.name = "lime";
  f.crown_base = 0.22f;
  f.outline = {0.7f, 1.0f, 0.95f, 0.8f, 0.55f, 0.37f};
  f.leader = 0.8f;
  f.branches[0].count = 46;
  f.branches[0].angle_low_deg = 85;
  f.branches[0].rise = -0.2f;
  f.branches[0].tip_rise = 0.35f;
  f.leaf = Leaf::heart;
  f.leaf_length_m = 0.07f;
  f.leaf_width_share = 0.95f;
  f.leaf_area_index = 8.4f;
  f.spray_hang = 0.2f;
  f.tumble = 0.4f;
  f.leaf_colour = {0.073f, 0.140f, 0.046f};
  f.bark = Bark::fissured;
  f.bark_colour = f.bark_upper_colour = {0.15f, 0.14f, 0.12f};
  return f;
}

Form hornbeam() {
  Form f = beech();
  f.name = "hornbeam";
  f.crown_base = 0.22f;
  f.outline = {0.5f, 0.85f, 1.0f, 0.95f, 0.75f, 0.55f};
  f.leader = 0.4f;
  f.stem_crook = 0.28f;
  f.branches[0].angle_low_deg = 55;
  f.branches[0].angle_high_deg = 20;
  f.branches[0].crook = 0.4f;
  f.leaf_length_m = 0.07f;
  f.leaf_width_share = 0.52f;
  f.leaf_area_index = 7.7f;
  f.leaf_colour = {0.071f, 0.137f, 0.045f};
  f.bark_colour = f.bark_upper_colour = {0.17f, 0.17f, 0.16f};
  return f;
}

Form alder() {
  Form f = broadleaf();
  f.name = "alder";
  f.few_cards_area = 0.9f;
  f.crown_base = 0.26f;
  f.outline = {0.6f, 1.0f, 0.92f, 0.75f, 0.5f, 0.08f};
  f.leader = 0.97f;
  f.stem_crook = 0.12f;
  f.branches[0] = {.count = 40,
                   .angle_low_deg = 72,
                   .angle_high_deg = 40,
                   .length_low = 0.95f,
                   .length_high = 0.95f,
                   .vary = 0.3f,
                   .rise = 0.1f,
                   .tip_rise = 0.15f,
                   .crook = 0.3f,
                   .thick = 0.35f};
  f.leaf_length_m = 0.075f;
  f.leaf_width_share = 0.85f;
  f.leaf_area_index = 6.3f;
  f.leaf_colour = {0.047f, 0.090f, 0.030f};
  f.bark = Bark::plated;
  f.bark_colour = f.bark_upper_colour = {0.14f, 0.125f, 0.11f};
  return f;
}

Form rowan() {
  Form f = ash();
  f.name = "rowan";
  f.crown_base = 0.2f;
  f.outline = {0.5f, 0.85f, 1.0f, 0.9f, 0.7f, 0.45f};
  f.leader = 0.5f;
  f.branches[0].angle_low_deg = 45;
  f.leaf_length_m = 0.16f;
  f.leaf_area_index = 4.5f;
  f.stem_radius_share = 0.0085f;
  f.leaf_colour = {0.073f, 0.140f, 0.046f};
  f.flowers = 160;
  f.flower_size_m = 0.1f;
  f.flower_colour = {0.42f, 0.07f, 0.01f};
  f.bark = Bark::smooth;
  f.bark_colour = f.bark_upper_colour = {0.20f, 0.195f, 0.18f};
  return f;
}

Form plane() {
  Form f = maple();
  f.name = "plane";
  f.few_cards_area = 1.1f;
  f.crown_base = 0.3f;
  f.ragged = 0.25f;
  f.branches[0].count = 38;
  f.branches[0].crook = 0.5f;
  f.stem_radius_share = 0.0115f;
  f.leaf_length_m = 0.18f;
  f.leaf_area_index = 6.3f;
  f.leaf_colour = {0.081f, 0.152f, 0.050f};
  f.bark_colour = {0.22f, 0.20f, 0.16f};
  f.bark_upper_colour = {0.46f, 0.45f, 0.38f};
  f.bark_upper_share = 0.25f;
  return f;
}

Form sweetgum() {
  Form f = maple();
  f.name = "sweetgum";
  f.few_cards_area = 1.06f;
  f.outline = {0.7f, 1.0f, 0.95f, 0.8f, 0.55f, 0.08f};
  f.leader = 0.95f;
  f.stem_crook = 0.1f;
  f.branches[0].thick = 0.35f;
  f.branches[0].count = 60;
  f.leaf_length_m = 0.13f;
  f.leaf_colour = {0.071f, 0.137f, 0.045f};
  f.bark = Bark::fissured;
  f.bark_colour = f.bark_upper_colour = {0.17f, 0.155f, 0.135f};
  return f;
}

Form tulip_tree() {
  Form f = sweetgum();
  f.name = "tulip tree";
  f.few_cards_area = 1.1f;
  f.crown_base = 0.42f;
  f.outline = {0.6f, 0.95f, 1.0f, 0.9f, 0.65f, 0.4f};
  f.leaf_length_m = 0.15f;
  f.leaf_colour = {0.081f, 0.156f, 0.051f};
  f.bark_colour = f.bark_upper_colour = {0.20f, 0.19f, 0.17f};
  return f;
}

// Slender, the finest twigs hang.
Form birch() {
  Form f = broadleaf();
  f.name = "birch";
  f.few_cards_area = 0.62f;
  f.crown_base = 0.28f;
  f.outline = {0.6f, 1.0f, 0.97f, 0.8f, 0.5f, 0.06f};
  f.ragged = 0.2f;
  f.leader = 0.95f;
  f.stem_radius_share = 0.0068f;
  f.stem_crook = 0.16f;
  f.branches[0] = {.count = 34,
                   .angle_low_deg = 50,
                   .angle_high_deg = 28,
                   .length_low = 0.9f,
                   .length_high = 0.9f,
                   .vary = 0.35f,
                   .rise = 0.1f,
                   .tip_rise = -0.7f,
                   .crook = 0.35f,
                   .thick = 0.4f};
  f.branches[1] = {.count = 14,
                   .bare_share = 0.25f,
                   .angle_low_deg = 50,
                   .angle_high_deg = 40,
                   .length_low = 0.45f,
                   .length_high = 0.25f,
                   .planar = 0.2f,
                   .rise = -0.2f,
                   .tip_rise = -1.0f,
                   .crook = 0.3f};
  f.branches[2] = {.count = 8,
                   .bare_share = 0.1f,
                   .angle_low_deg = 50,
                   .angle_high_deg = 40,
                   .length_low = 0.75f,
                   .length_high = 0.5f,
                   .planar = 0.2f,
                   .rise = -1.3f,
                   .tip_rise = -1.6f,
                   .crook = 0.2f};
  f.leaf = Leaf::small;
  f.leaf_length_m = 0.05f;
  f.leaf_width_share = 0.8f;
  f.leaf_area_index = 4.4f;
  f.spray_hang = 0.45f;
  f.tumble = 0.8f;
  f.leaf_colour = {0.081f, 0.156f, 0.051f};
  f.leaf_vary = 0.3f;
  f.bark = Bark::birch;
  f.bark_colour = f.bark_upper_colour = {0.58f, 0.57f, 0.54f};
  f.twig_colour = {0.07f, 0.045f, 0.035f};
  return f;
}

Form river_birch() {
  Form f = birch();
  f.name = "river birch";
  f.leader = 0.5f;
  f.branches[2].rise = -0.6f;
  f.branches[2].tip_rise = -0.8f;
  f.leaf_area_index = 5.2f;
  f.bark = Bark::plated;
  f.bark_colour = f.bark_upper_colour = {0.34f, 0.25f, 0.19f};
  return f;
}

Form willow() {
  Form f = broadleaf();
  f.name = "willow";
  f.few_cards_area = 1.08f;
  f.crown_base = 0.2f;
  f.outline = {0.75f, 1.0f, 1.0f, 0.9f, 0.7f, 0.5f};
  f.ragged = 0.25f;
  f.leader = 0.3f;
  f.stem_radius_share = 0.0125f;
  f.stem_crook = 0.3f;
  f.branches[0] = {.count = 22,
                   .angle_low_deg = 60,
                   .angle_high_deg = 25,
                   .length_low = 1.0f,
                   .length_high = 0.95f,
                   .vary = 0.3f,
                   .rise = 0.3f,
                   .tip_rise = -0.2f,
                   .crook = 0.6f,
                   .thick = 0.6f};
  f.branches[1] = {.count = 16,
                   .bare_share = 0.25f,
                   .angle_low_deg = 45,
                   .angle_high_deg = 35,
                   .length_low = 0.5f,
                   .length_high = 0.3f,
                   .planar = 0.1f,
                   .rise = 0.2f,
                   .tip_rise = -0.4f,
                   .crook = 0.4f};
  f.branches[2] = {.count = 10,
                   .bare_share = 0.1f,
                   .angle_low_deg = 42,
                   .angle_high_deg = 30,
                   .length_low = 0.6f,
                   .length_high = 0.45f,
                   .planar = 0.1f,
                   .rise = -0.2f,
                   .tip_rise = -0.7f,
                   .crook = 0.2f};
  f.leaf = Leaf::lanceolate;
  f.leaf_length_m = 0.11f;
  f.leaf_width_share = 0.19f;
  f.leaf_area_index = 5;
  f.spray_angle_deg = 30;
  f.spray_hang = 0.3f;
  f.tumble = 0.8f;
  f.leaf_colour = {0.095f, 0.156f, 0.066f};
  f.leaf_passes = {0.65f, 0.8f, 0.4f};
  f.bark = Bark::fissured;
  f.bark_colour = f.bark_upper_colour = {0.18f, 0.165f, 0.14f};
  f.twig_colour = {0.14f, 0.12f, 0.05f};
  return f;
}

Form poplar() {
  Form f = alder();
  f.name = "poplar";
  f.few_cards_area = 0.95f;
  f.leader = 0.8f;
  f.outline = {0.5f, 0.85f, 1.0f, 0.9f, 0.65f, 0.4f};
  f.branches[0].angle_low_deg = 50;
  f.leaf = Leaf::small;
  f.leaf_length_m = 0.07f;
  f.leaf_width_share = 0.95f;
  f.leaf_area_index = 4.5f;
  f.leaf_colour = {0.076f, 0.140f, 0.046f};
  f.bark_colour = f.bark_upper_colour = {0.27f, 0.27f, 0.23f};
  return f;
}

}  // namespace assets::grown::presets
