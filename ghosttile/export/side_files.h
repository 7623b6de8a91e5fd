// Files beside the one that is exported: textures, materials. They appear together, at commit().
//
// Errors: as base::NewFile, and where one would bear the export's own name.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ghosttile/export/names.h"
#include "ghosttile/export/survey.h"
#include "silvasim/base/file.h"

namespace ghosttile::exports {

class SideFiles {
 public:
  SideFiles(const std::filesystem::path& main, std::span<const std::filesystem::path> inputs)
      : main_(main), inputs_(inputs), stem_(word_of(main.stem().string())) {}

  // The file <name of the export><ending>, or with a number in it where that is taken. Returns its name, without folder.
  std::string add(const std::string& ending, const std::string& bytes);
  void commit();

 private:
  std::filesystem::path main_;
  std::span<const std::filesystem::path> inputs_;
  std::string stem_;
  UniqueNames names_;
  std::vector<std::unique_ptr<silvasim::base::NewFile>> files_;
};

// Adds all textures of the objects that stand somewhere: their files' names, by object and texture.
std::vector<std::vector<std::string>> add_textures(SideFiles& files, const fill::DetailsFile& details,
                                                   const Survey& survey);

}  // namespace ghosttile::exports
