// Names of objects, materials and textures, made fit for files, each once.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace ghosttile::exports {

// Letters, digits, '.', '-', '_' and what is no ASCII stay; all else becomes '_'. Never empty.
std::string word_of(std::string_view name);

// A name that programming languages would take: letters, digits and '_', no digit first.
std::string identifier_of(std::string_view name);

// The wanted names, with a number behind where one is taken.
class UniqueNames {
 public:
  std::string operator()(std::string wanted) {
    std::string name = wanted;
    for (int i = 2; !taken_.insert(name).second; ++i) name = wanted + "_" + std::to_string(i);
    return name;
  }

 private:
  std::set<std::string> taken_;
};

}  // namespace ghosttile::exports
