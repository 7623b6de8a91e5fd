#include "silvasim/export/text_rows.h"

#include <algorithm>
#include <vector>

#include "silvasim/base/file.h"
#include "silvasim/base/parallel.h"

namespace silvasim::exports {

void write_text_rows(const std::filesystem::path& path, const PlantRows& rows, const std::string& head,
                     const std::function<void(std::size_t portion, std::string& text)>& text_of,
                     const std::string& foot, const base::Progress& progress) {
  base::NewFile file(path);
  file.write(head);
  std::vector<std::string> texts(16);
  for (std::size_t first = 0; first < rows.portions(); first += texts.size()) {
    base::report(progress, "write", static_cast<double>(first) / static_cast<double>(rows.portions()));
    const std::size_t count = std::min(texts.size(), rows.portions() - first);
    base::parallel_for(count, [&](std::size_t i) {
      texts[i].clear();
      text_of(first + i, texts[i]);
    });
    for (std::size_t i = 0; i < count; ++i) file.write(texts[i]);
  }
  file.write(foot);
  file.commit();
  base::report(progress, "write", 1);
}

}  // namespace silvasim::exports
