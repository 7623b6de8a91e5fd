#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "assets/grown/form.h"
#include "assets/grown/presets.h"

namespace assets::grown {

namespace {

struct Known {
  Form (*preset)();
  const char* names;  // species, genera and English words, in small letters, separated by commas
};

// Species are looked for before genera. The order is that of the manual.
constexpr std::array table = {
    Known{presets::beech, "fagus,beech,castanea,chestnut,ulmus,elm"},
    Known{presets::oak, "quercus,oak,quercus alba,white oak"},
    Known{presets::red_oak, "quercus rubra,quercus falcata,quercus velutina,quercus coccinea,red oak"},
    Known{presets::maple, "acer,maple,sycamore maple"},
    Known{presets::ash, "fraxinus,ash,robinia,locust"},
    Known{presets::hickory, "carya,hickory,juglans,walnut,pecan"},
    Known{presets::lime, "tilia,lime,linden,basswood"},
    Known{presets::hornbeam, "carpinus,hornbeam,ostrya"},
    Known{presets::alder, "alnus,alder"},
    Known{presets::rowan, "sorbus,rowan"},
    Known{presets::plane, "platanus,plane,american sycamore"},
    Known{presets::sweetgum, "liquidambar,sweetgum"},
    Known{presets::tulip_tree, "liriodendron,tulip,magnolia"},
    Known{presets::birch, "betula,birch"},
    Known{presets::river_birch, "betula nigra,river birch"},
    Known{presets::willow, "salix,willow"},
    Known{presets::poplar, "populus,poplar,aspen,cottonwood"},
    Known{presets::broadleaf, "prunus,cherry,malus,apple,pyrus,pear,nothofagus,eucalyptus,broadleaf"},
    Known{presets::spruce, "picea,spruce"},
    Known{presets::fir, "abies,fir"},
    Known{presets::subalpine_fir, "abies lasiocarpa,subalpine fir"},
    Known{presets::douglas_fir, "pseudotsuga,douglas fir,douglas-fir,sequoia,sequoiadendron"},
    Known{presets::hemlock, "tsuga,hemlock"},
    Known{presets::redcedar, "thuja,redcedar,cedar,western redcedar,calocedrus,chamaecyparis"},
    Known{presets::nootka_cypress, "callitropsis,xanthocyparis,alaska-cedar,cupressus,cypress"},
    Known{presets::juniper, "juniperus,juniper,eastern redcedar"},
    Known{presets::pine, "pinus,pine"},
    Known{presets::tall_pine, "pinus taeda,pinus monticola,pinus strobus,pinus ponderosa,loblolly pine,white pine"},
    Known{presets::whitebark_pine, "pinus albicaulis,pinus cembra,pinus mugo,whitebark pine"},
    Known{presets::larch, "larix,larch,tamarack"},
    Known{presets::yew, "taxus,yew"},
    Known{presets::conifer, "cedrus,conifer"},
    Known{presets::hazel, "corylus,hazel,amelanchier"},
    Known{presets::hawthorn, "crataegus,hawthorn,blackthorn,prunus spinosa,rosa,rose"},
    Known{presets::elder, "sambucus,elder"},
    Known{presets::red_elder, "sambucus racemosa,red elder"},
    Known{presets::buckthorn, "frangula,rhamnus,buckthorn,cornus,dogwood,viburnum,lonicera,euonymus"},
    Known{presets::shrub_willow, "salix cinerea,salix aurita,salix caprea,salix purpurea,grey willow"},
    Known{presets::shrub, "shrub,vaccinium,rhododendron,ilex,ligustrum,cytisus,ribes,rubus"},
    Known{presets::fern, "fern,pteridium,dryopteris,athyrium,polystichum,blechnum,matteuccia"},
    Known{presets::grass,
          "grass,deschampsia,molinia,carex,poa,festuca,calamagrostis,dactylis,juncus,luzula,phragmites"},
    Known{presets::herb, "herb,flower,achillea,leucanthemum,urtica,chamerion,epilobium,lupinus,trifolium"},
};

std::string in_small_letters(const std::string& text) {
  std::string small;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    small += c == '_' ? ' ' : static_cast<char>(u < 128 ? std::tolower(u) : u);
  }
  return small;
}

// Calls use(name, preset) for each name until it says true.
template <typename Use>
void each_name(Use&& use) {
  for (const Known& known : table) {
    std::string_view rest = known.names;
    while (!rest.empty()) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      if (use(rest.substr(0, comma), known.preset)) return;
      rest.remove_prefix(std::min(rest.size(), comma + 1));
    }
  }
}

}  // namespace

Form form_of(const std::string& scientific_name, double height_m, double radius_m, bool* known) {
  const std::string name = in_small_letters(scientific_name);
  Form (*found)() = nullptr;
  std::size_t longest = 0;
  // The longest name of the table that stands in `name` as whole words: "quercus rubra" before "quercus".
  each_name([&](std::string_view entry, Form (*preset)()) {
    for (std::size_t at = name.find(entry); at != std::string::npos; at = name.find(entry, at + 1)) {
      const auto letter = [&](std::size_t i) {
        return i < name.size() && std::isalpha(static_cast<unsigned char>(name[i]));
      };
      const bool whole = !(at > 0 && letter(at - 1)) && !letter(at + entry.size());
      if (whole && entry.size() > longest) {
        longest = entry.size();
        found = preset;
      }
    }
    return false;
  });
  if (known != nullptr) *known = found != nullptr;
  if (found != nullptr) return found();
  if (height_m < 0.6) return presets::herb();
  if (height_m < 6) return presets::shrub();
  return height_m >= 16 * radius_m ? presets::conifer() : presets::broadleaf();
}

std::vector<std::string> known_names() {
  std::vector<std::string> names;
  each_name([&](std::string_view entry, Form (*)()) {
    names.emplace_back(entry);
    return false;
  });
  return names;
}

std::vector<Form> all_forms() {
  std::vector<Form> forms;
  for (const Known& known : table) forms.push_back(known.preset());
  return forms;
}

}  // namespace assets::grown
