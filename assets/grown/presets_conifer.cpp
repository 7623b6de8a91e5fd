#include "assets/grown/presets.h"

namespace assets::grown::presets {

// One straight stem, whorls of branches, a cone.
Form conifer() {
  Form f;
  f.name = "conifer";
  f.few_cards_area = 0.88f;
  f.crown_base = 0.12f;
  f.outline = {1.0f, 0.92f, 0.74f, 0.52f, 0.28f, 0.015f};
  f.ragged = 0.08f;
  f.stem_crook = 0.03f;
  f.stem_lean_deg = 0.5f;
  f.branches[0] = {.count = 165,
                   .whorl = 5,
                   .angle_low_deg = 98,
                   .angle_high_deg = 42,
                   .length_low = 1.0f,
                   .length_high = 1.0f,
                   .vary = 0.3f,
                   .rise = -0.1f,
                   .tip_rise = 0.15f,
                   .crook = 0.15f,
                   .thick = 0.22f};
  f.branches[1] = {.count = 30,
                   .bare_share = 0.15f,
                   .angle_low_deg = 60,
                   .angle_high_deg = 45,
                   .length_low = 0.42f,
                   .length_high = 0.14f,
                   .planar = 0.85f,
                   .rise = -0.1f,
                   .crook = 0.15f};
  f.branches[2] = {};
  f.orders = 2;
  f.leafed_share = 0.95f;
  f.inner_leaves = 0.7f;
  f.leaf = Leaf::bottle;
  f.leaf_length_m = 0.018f;
  f.leaf_area_index = 8.5f;
  f.spray_angle_deg = 35;
  f.tumble = 0.4f;
  f.leaf_vary = 0.2f;
  f.leaf_colour = {0.041f, 0.076f, 0.032f};
  f.leaf_passes = {0.45f, 0.6f, 0.25f};
  f.bark = Bark::plated;
  f.bark_colour = f.bark_upper_colour = {0.15f, 0.115f, 0.095f};
  f.twig_colour = {0.10f, 0.07f, 0.045f};
  return f;
}

// The branches sag and lift their tips; the side shoots hang from them like combs.
Form spruce() {
  Form f = conifer();
  f.name = "spruce";
  f.few_cards_area = 0.88f;
  f.branches[0].angle_low_deg = 104;
  f.branches[0].angle_high_deg = 38;
  f.branches[0].rise = -0.35f;
  f.branches[0].tip_rise = 0.5f;
  f.branches[1].rise = -0.9f;
  f.branches[1].tip_rise = -0.9f;
  f.spray_hang = 0.4f;
  f.tumble = 0.5f;
  f.leaf_colour = {0.037f, 0.068f, 0.029f};
  f.bark_colour = f.bark_upper_colour = {0.16f, 0.115f, 0.09f};
  return f;
}

// Stiff, flat tiers.
Form fir() {
  Form f = conifer();
  f.name = "fir";
  f.few_cards_area = 0.95f;
  f.crown_base = 0.2f;
  f.outline = {0.95f, 1.0f, 0.88f, 0.68f, 0.42f, 0.05f};
  f.branches[0].angle_low_deg = 92;
  f.branches[0].angle_high_deg = 62;
  f.branches[0].rise = 0;
  f.branches[0].tip_rise = 0.08f;
  f.branches[0].crook = 0.08f;
  f.branches[1].planar = 0.65f;
  f.branches[1].rise = 0;
  f.branches[1].length_low = 0.5f;
  f.leaf = Leaf::comb;
  f.leaf_length_m = 0.024f;
  f.leaf_area_index = 9.5f;
  f.tumble = 0.38f;
  f.leaf_colour = {0.036f, 0.066f, 0.030f};
  f.bark = Bark::smooth;
  f.bark_colour = f.bark_upper_colour = {0.22f, 0.215f, 0.20f};
  return f;
}

// A spire with branches to the ground.
Form subalpine_fir() {
  Form f = fir();
  f.name = "subalpine fir";
  f.few_cards_area = 0.92f;
  f.crown_base = 0.03f;
  f.outline = {1.0f, 0.72f, 0.52f, 0.36f, 0.2f, 0.02f};
  f.branches[0].angle_low_deg = 108;
  f.branches[0].angle_high_deg = 75;
  f.leaf_colour = {0.050f, 0.083f, 0.042f};
  return f;
}

Form douglas_fir() {
  Form f = conifer();
  f.name = "Douglas fir";
  f.few_cards_area = 1.0f;
  f.crown_base = 0.32f;
  f.outline = {0.85f, 1.0f, 0.9f, 0.7f, 0.42f, 0.03f};
  f.ragged = 0.2f;
  f.stem_radius_share = 0.0105f;
  f.branches[0].count = 240;
  f.branches[0].whorl = 4;
  f.branches[0].vary = 0.5f;
  f.branches[0].angle_low_deg = 100;
  f.branches[0].rise = -0.15f;
  f.branches[0].tip_rise = 0.3f;
  f.branches[0].crook = 0.25f;
  f.branches[1].rise = -0.5f;
  f.branches[1].tip_rise = -0.3f;
  f.spray_hang = 0.25f;
  f.leaf_length_m = 0.025f;
  f.leaf_colour = {0.045f, 0.083f, 0.037f};
  f.bark = Bark::fissured;
  f.bark_colour = f.bark_upper_colour = {0.15f, 0.115f, 0.09f};
  return f;
}

Form hemlock() {
  Form f = conifer();
  f.name = "hemlock";
  f.few_cards_area = 1.0f;
  f.crown_base = 0.18f;
  f.outline = {0.9f, 1.0f, 0.85f, 0.62f, 0.36f, 0.04f};
  f.tip_droop = 1;
  f.branches[0].angle_low_deg = 95;
  f.branches[0].angle_high_deg = 55;
  f.branches[0].rise = -0.2f;
  f.branches[0].tip_rise = -0.45f;
  f.branches[1].rise = -0.3f;
  f.branches[1].tip_rise = -0.5f;
  f.leaf = Leaf::comb;
  f.leaf_length_m = 0.014f;
  f.leaf_area_index = 9;
  f.tumble = 0.25f;
  f.spray_hang = 0.15f;
  f.leaf_colour = {0.048f, 0.088f, 0.034f};
  f.bark = Bark::fissured;
  return f;
}

// Fans of scales; branches sweep down and up again.
Form redcedar() {
  Form f = conifer();
  f.name = "redcedar";
  f.few_cards_area = 0.97f;
  f.crown_base = 0.14f;
  f.outline = {0.95f, 1.0f, 0.86f, 0.63f, 0.36f, 0.03f};
  f.stem_radius_share = 0.012f;
  f.flare = 1.1f;
  f.branches[0].whorl = 1;
  f.branches[0].count = 230;
  f.branches[0].angle_low_deg = 98;
  f.branches[0].angle_high_deg = 50;
  f.branches[0].rise = -0.5f;
  f.branches[0].tip_rise = 0.7f;
  f.branches[1].rise = -0.5f;
  f.branches[1].tip_rise = -0.5f;
  f.leaf = Leaf::scales;
  f.leaf_length_m = 0.06f;
  f.leaf_area_index = 8.5f;
  f.spray_hang = 0.55f;
  f.tumble = 0.5f;
  f.leaf_colour = {0.057f, 0.105f, 0.038f};
  f.bark = Bark::stringy;
  f.bark_colour = f.bark_upper_colour = {0.19f, 0.135f, 0.105f};
  return f;
}

Form nootka_cypress() {
  Form f = redcedar();
  f.name = "Nootka cypress";
  f.few_cards_area = 0.93f;
  f.crown_base = 0.08f;
  f.outline = {1.0f, 0.9f, 0.72f, 0.52f, 0.3f, 0.03f};
  f.tip_droop = 0.8f;
  f.branches[0].count = 180;
  f.branches[0].rise = -0.6f;
  f.branches[0].tip_rise = -0.1f;
  f.branches[1].rise = -1.2f;
  f.branches[1].tip_rise = -1.0f;
  f.spray_hang = 0.8f;
  f.leaf_area_index = 7.5f;
  f.leaf_colour = {0.050f, 0.093f, 0.043f};
  f.bark_colour = f.bark_upper_colour = {0.22f, 0.195f, 0.17f};
  return f;
}

Form juniper() {
  Form f = conifer();
  f.name = "juniper";
  f.few_cards_area = 1.0f;
  f.crown_base = 0.05f;
  f.outline = {0.7f, 1.0f, 0.98f, 0.8f, 0.5f, 0.06f};
  f.stem_radius_share = 0.011f;
  f.orders = 2;
  f.branches[0] = {.count = 80,
                   .whorl = 1,
                   .angle_low_deg = 55,
                   .angle_high_deg = 28,
                   .length_low = 0.95f,
                   .length_high = 0.95f,
                   .vary = 0.3f,
                   .rise = 0.3f,
                   .tip_rise = 0.2f,
                   .crook = 0.3f,
                   .thick = 0.4f};
  f.branches[1] = {.count = 24,
                   .bare_share = 0.15f,
                   .angle_low_deg = 50,
                   .angle_high_deg = 35,
                   .length_low = 0.4f,
                   .length_high = 0.2f,
                   .planar = 0.1f,
                   .rise = 0.3f,
                   .tip_rise = 0.2f,
                   .crook = 0.3f};
  f.leaf = Leaf::scales;
  f.leaf_length_m = 0.05f;
  f.leaf_area_index = 9.8f;
  f.spray_hang = -0.2f;
  f.tumble = 1;
  f.leaf_colour = {0.051f, 0.085f, 0.039f};
  f.bark = Bark::stringy;
  f.bark_colour = f.bark_upper_colour = {0.20f, 0.15f, 0.12f};
  return f;
}

// Scots pine: a long bare stem, rust-red above, and an umbrella of tufts.
Form pine() {
  Form f = conifer();
  f.name = "pine";
  f.few_cards_area = 0.84f;
  f.crown_base = 0.6f;
  f.outline = {0.4f, 0.8f, 1.0f, 1.0f, 0.9f, 0.6f};
  f.ragged = 0.28f;
  f.leader = 0.6f;
  f.stem_radius_share = 0.0085f;
  f.stem_crook = 0.16f;
  f.branches[0] = {.count = 36,
                   .whorl = 3,
                   .angle_low_deg = 88,
                   .angle_high_deg = 35,
                   .length_low = 0.95f,
                   .length_high = 0.95f,
                   .vary = 0.35f,
                   .rise = 0.05f,
                   .tip_rise = 0.35f,
                   .crook = 0.6f,
                   .thick = 0.4f};
  f.branches[1] = {.count = 17,
                   .bare_share = 0.4f,
                   .angle_low_deg = 55,
                   .angle_high_deg = 40,
                   .length_low = 0.5f,
                   .length_high = 0.3f,
                   .planar = 0.4f,
                   .rise = 0.4f,
                   .tip_rise = 0.4f,
                   .crook = 0.5f};
  f.branches[2] = {.count = 9,
                   .bare_share = 0.3f,
                   .angle_low_deg = 50,
                   .angle_high_deg = 35,
                   .length_low = 0.5f,
                   .length_high = 0.4f,
                   .planar = 0.2f,
                   .rise = 0.5f,
                   .tip_rise = 0.4f,
                   .crook = 0.4f};
  f.orders = 3;
  f.leafed_share = 0.65f;
  f.inner_leaves = 0.2f;
  f.leaf = Leaf::tuft;
  f.leaf_length_m = 0.06f;
  f.leaf_area_index = 4.2f;
  f.spray_angle_deg = 35;
  f.spray_hang = -0.25f;
  f.tumble = 0.9f;
  f.leaf_colour = {0.051f, 0.090f, 0.041f};
  f.bark_colour = {0.17f, 0.13f, 0.11f};
  f.bark_upper_colour = {0.34f, 0.17f, 0.085f};
  f.bark_upper_share = 0.38f;
  f.twig_colour = {0.20f, 0.11f, 0.06f};
  return f;
}

// Loblolly and white pines: a straighter stem, a longer crown of open layers.
Form tall_pine() {
  Form f = pine();
  f.name = "tall pine";
  f.few_cards_area = 0.95f;
  f.crown_base = 0.42f;
  f.outline = {0.7f, 1.0f, 0.95f, 0.8f, 0.55f, 0.08f};
  f.ragged = 0.2f;
  f.leader = 1.0f;
  f.stem_crook = 0.05f;
  f.branches[0].count = 56;
  f.branches[0].whorl = 4;
  f.branches[0].angle_low_deg = 85;
  f.branches[0].angle_high_deg = 45;
  f.branches[0].thick = 0.3f;
  f.branches[0].crook = 0.3f;
  f.branches[1].planar = 0.7f;
  f.leaf_length_m = 0.12f;
  f.leaf_area_index = 4.8f;
  f.bark_colour = f.bark_upper_colour = {0.18f, 0.14f, 0.115f};
  f.bark_upper_share = 1;
  return f;
}

// At the timberline: low, broad, often forked near the ground.
Form whitebark_pine() {
  Form f = pine();
  f.name = "whitebark pine";
  f.few_cards_area = 0.82f;
  f.crown_base = 0.16f;
  f.outline = {0.5f, 0.85f, 1.0f, 0.95f, 0.75f, 0.3f};
  f.leader = 0.35f;
  f.stem_radius_share = 0.018f;
  f.stem_crook = 0.5f;
  f.branches[0].count = 34;
  f.branches[0].whorl = 1;
  f.branches[0].angle_low_deg = 65;
  f.leaf_length_m = 0.055f;
  f.leaf_area_index = 5;
  f.leaf_colour = {0.059f, 0.098f, 0.045f};
  f.bark_colour = f.bark_upper_colour = {0.28f, 0.26f, 0.24f};
  f.bark_upper_share = 1;
  return f;
}

Form larch() {
  Form f = conifer();
  f.name = "larch";
  f.few_cards_area = 0.74f;
  f.crown_base = 0.22f;
  f.outline = {0.9f, 1.0f, 0.84f, 0.6f, 0.34f, 0.03f};
  f.ragged = 0.2f;
  f.branches[0] = {.count = 90,
                   .whorl = 1,
                   .angle_low_deg = 95,
                   .angle_high_deg = 55,
                   .length_low = 1.0f,
                   .length_high = 1.0f,
                   .vary = 0.45f,
                   .rise = -0.15f,
                   .tip_rise = 0.4f,
                   .crook = 0.3f,
                   .thick = 0.25f};
  f.branches[1] = {.count = 18,
                   .bare_share = 0.15f,
                   .angle_low_deg = 60,
                   .angle_high_deg = 45,
                   .length_low = 0.4f,
                   .length_high = 0.2f,
                   .planar = 0.5f,
                   .rise = -0.9f,
                   .tip_rise = -0.9f,
                   .crook = 0.25f};
  f.leaf = Leaf::rosette;
  f.leaf_length_m = 0.03f;
  f.leaf_area_index = 4.8f;
  f.spray_hang = 0.4f;
  f.tumble = 0.8f;
  f.leaf_colour = {0.078f, 0.144f, 0.052f};
  f.leaf_passes = {0.5f, 0.7f, 0.25f};
  f.bark_colour = f.bark_upper_colour = {0.20f, 0.15f, 0.125f};
  f.twig_colour = {0.20f, 0.16f, 0.09f};
  return f;
}

Form yew() {
  Form f = juniper();
  f.name = "yew";
  f.branches[1].length_low = 0.5f;
  f.branches[1].count = 36;
  f.few_cards_area = 0.95f;
  f.outline = {0.8f, 1.0f, 1.0f, 0.85f, 0.6f, 0.15f};
  f.leader = 0.4f;
  f.branches[0].angle_low_deg = 75;
  f.leaf = Leaf::comb;
  f.leaf_length_m = 0.025f;
  f.leaf_colour = {0.030f, 0.056f, 0.022f};
  f.tumble = 0.4f;
  f.bark_colour = f.bark_upper_colour = {0.17f, 0.11f, 0.085f};
  return f;
}

}  // namespace assets::grown::presets
