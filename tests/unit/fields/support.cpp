#include "support.h"

#include <cmath>
#include <cstdlib>
#include <fstream>

namespace silvasim::fields {

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "silva-fields-XXXXXX").string();
  path_ = mkdtemp(pattern.data());
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

void write_grid(const std::filesystem::path& path, int columns, int rows, double west, double south, double cell,
                const std::vector<double>& values) {
  std::ofstream out(path);
  out.precision(17);
  out << "ncols " << columns << "\nnrows " << rows << "\nxllcorner " << west << "\nyllcorner " << south << "\ncellsize "
      << cell << "\nNODATA_value -9999\n";
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double value = values[static_cast<std::size_t>(row * columns + column)];
      out << (column ? " " : "");
      if (std::isnan(value))
        out << -9999;
      else
        out << value;
    }
    out << "\n";
  }
}

}  // namespace silvasim::fields
