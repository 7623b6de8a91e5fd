#include "silvasim/export/formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.h"
#include "made_land.h"
#include "silvasim/base/error.h"

namespace silvasim::exports {
namespace {

using ::testing::HasSubstr;

std::string message_of(const std::string& format, const std::filesystem::path& path) {
  try {
    export_to(testing::make_land({}), format, path);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no base::ConfigError";
}

TEST(Formats, are_found_by_name_or_extension) {
  const testing::Folder folder;
  const ecosystem::Ecosystem land = testing::make_land({});
  export_to(land, "", folder / "by-extension.CSV");
  export_to(land, "csv", folder / "by-name.txt");
  EXPECT_EQ(testing::content(folder / "by-extension.CSV"), testing::content(folder / "by-name.txt"));
}

TEST(Formats, unknown_ones_are_answered_with_known_ones) {
  const testing::Folder folder;
  EXPECT_THAT(message_of("gpgk", folder / "f"), HasSubstr("did you mean \"gpkg\"?"));
  EXPECT_THAT(message_of("shapefile", folder / "f"), HasSubstr("give one of csv, gpkg, fgb, geojson, tif"));
  EXPECT_THAT(message_of("", folder / "f.xyz"), HasSubstr("give one of csv, gpkg, fgb, geojson, tif"));
  EXPECT_TRUE(folder.names().empty());
}

TEST(Formats, every_one_leaves_nothing_where_it_cannot_write) {
  const testing::Folder folder;
  for (const Format& format : formats()) {
    EXPECT_FALSE(format.help.empty());
    EXPECT_THROW(export_to(testing::make_land({}), format.name, folder / "missing/f"), base::Error);
    EXPECT_THROW(export_to(testing::make_land({}), format.name, folder / ("f" + format.extensions[0]),
                           [](std::string_view, double) { return false; }),
                 base::Cancelled);
    EXPECT_TRUE(folder.names().empty()) << format.name;
  }
}

}  // namespace
}  // namespace silvasim::exports
