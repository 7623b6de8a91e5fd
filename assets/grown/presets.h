// The presets behind form_of(), one function a form, by groups.
#pragma once

#include "assets/grown/form.h"

namespace assets::grown::presets {

// Broadleaved trees (presets_broadleaf.cpp)
Form broadleaf();
Form beech();
Form oak();
Form red_oak();
Form maple();
Form ash();
Form hickory();
Form lime();
Form hornbeam();
Form alder();
Form rowan();
Form plane();
Form sweetgum();
Form tulip_tree();
Form birch();
Form river_birch();
Form willow();
Form poplar();

// Conifers (presets_conifer.cpp)
Form conifer();
Form spruce();
Form fir();
Form subalpine_fir();
Form douglas_fir();
Form hemlock();
Form redcedar();
Form nootka_cypress();
Form juniper();
Form pine();
Form tall_pine();
Form whitebark_pine();
Form larch();
Form yew();

// Shrubs and what is lower (presets_low.cpp)
Form shrub();
Form hazel();
Form hawthorn();
Form elder();
Form red_elder();
Form buckthorn();
Form shrub_willow();
Form fern();
Form grass();
Form herb();

}  // namespace assets::grown::presets
