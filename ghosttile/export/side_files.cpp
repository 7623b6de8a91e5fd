#include "ghosttile/export/side_files.h"

#include "ghosttile/export/png.h"
#include "silvasim/base/error.h"

namespace ghosttile::exports {

std::string SideFiles::add(const std::string& ending, const std::string& bytes) {
  const std::filesystem::path tail(ending);
  const std::string extension = tail.extension().empty() ? ending : tail.extension().string();
  const std::string name = names_(stem_ + ending.substr(0, ending.size() - extension.size())) + extension;
  if (name == main_.filename().string()) {
    throw silvasim::base::Error("cannot write \"" + main_.string() +
                                "\": a file of that name must stand beside it; give it another extension");
  }
  auto file = std::make_unique<silvasim::base::NewFile>(main_.parent_path() / name, inputs_);
  file->write(bytes);
  files_.push_back(std::move(file));
  return name;
}

void SideFiles::commit() {
  for (const auto& file : files_) file->commit();
}

std::vector<std::vector<std::string>> add_textures(SideFiles& files, const fill::DetailsFile& details,
                                                   const Survey& survey) {
  std::vector<std::vector<std::string>> names(details.tile->objects.size());
  for (const std::size_t o : survey.used) {
    const objects::Detail& object = details.tile->objects[o];
    for (const assets::Texture& texture : object.model.textures) {
      const std::string wanted =
          texture.name.empty() ? object.name : std::filesystem::path(texture.name).stem().string();
      names[o].push_back(files.add("-" + word_of(wanted) + ".png", png_of(texture)));
    }
  }
  return names;
}

}  // namespace ghosttile::exports
