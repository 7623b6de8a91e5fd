// No file that Silva reads makes it open another file by surprise, reach the network, or work for ever.
#include "silvasim/fields/containment.h"

#include <arpa/inet.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <fcntl.h>
#include <gdal_priv.h>
#include <netinet/in.h>
#include <ogrsf_frmts.h>
#include <sqlite3.h>
#include <sys/inotify.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <set>

#include "silvasim/fields/crs.h"
#include "silvasim/fields/drivers.h"
#include "silvasim/fields/feature_writer.h"
#include "silvasim/fields/open.h"
#include "support.h"

namespace silvasim::fields {
namespace {

// A server that nobody may talk to.
class Listener {
 public:
  Listener() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(socket_, 8), 0);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = std::to_string(ntohs(address.sin_port));
  }
  ~Listener() { close(socket_); }
  std::string url(const std::string& scheme = "http") const { return scheme + "://127.0.0.1:" + port_ + "/a.tif"; }
  bool was_called() const {
    const int connection = accept(socket_, nullptr, nullptr);
    if (connection >= 0) close(connection);
    return connection >= 0;
  }

 private:
  int socket_;
  std::string port_;
};

// A file that nobody may open.
class Canary {
 public:
  explicit Canary(const std::filesystem::path& path) : path_(path), watch_(inotify_init1(IN_NONBLOCK)) {
    EXPECT_GE(inotify_add_watch(watch_, path.c_str(), IN_OPEN | IN_ACCESS), 0);
  }
  ~Canary() { close(watch_); }
  const std::filesystem::path& path() const { return path_; }
  bool was_opened() const {
    char buffer[4096];
    return read(watch_, buffer, sizeof buffer) > 0;
  }

 private:
  std::filesystem::path path_;
  int watch_;
};

const config::SceneSettings local = scene_of("local", base::Box{0, 0, 1000, 1000});

std::string message_of(const config::SceneSettings& scene, const config::FieldSettings& field) {
  try {
    load_fields(scene, {field});
    return {};
  } catch (const base::Error& error) {
    return error.what();
  }
}

void make_tiff(const std::filesystem::path& path) {
  std::vector<float> values(100 * 100, 5.0f);
  Grid grid;
  grid.columns = grid.rows = 100;
  grid.north = 1000;
  grid.cell_width = grid.cell_height = 10;
  const Band band{std::span<const float>(values), ""};
  write_geotiff(path, grid, {&band, 1});
}

// A GeoTIFF that says that its overviews lie elsewhere.
void make_tiff_with_overviews(const std::filesystem::path& path, const std::string& elsewhere) {
  prepare_gdal();
  const Dataset dataset(
      GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), 100, 100, 1, GDT_Byte, nullptr));
  double transform[6] = {0, 10, 0, 1000, 0, -10};
  dataset->SetGeoTransform(transform);
  dataset->SetMetadataItem("OVERVIEW_FILE", elsewhere.c_str(), "OVERVIEWS");
  dataset->GetRasterBand(1)->Fill(7);
}

std::string vrt_of(const std::string& source) {
  return R"(<VRTDataset rasterXSize="100" rasterYSize="100"><GeoTransform>0,10,0,1000,0,-10</GeoTransform><VRTRasterBand dataType="Byte" band="1">)"
         R"(<SimpleSource><SourceFilename relativeToVRT="0">)" +
         source + "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
}

TEST(Containment, OnlyTheWantedDrivers) {
  prepare_gdal();
  std::set<std::string> known;
  for (int i = 0; i < GetGDALDriverManager()->GetDriverCount(); ++i)
    known.insert(GetGDALDriverManager()->GetDriver(i)->GetDescription());
  EXPECT_EQ(known,
            (std::set<std::string>{"GTiff", "PNG", "JPEG", "BMP", "AAIGrid", "HFA", "EHdr", "SRTMHGT", "DTED", "MEM",
                                   "ESRI Shapefile", "GeoJSON", "GeoJSONSeq", "GPKG", "FlatGeobuf", "CSV"}));
}

TEST(Containment, NoVirtualFileSystemButMemory) {
  prepare_gdal();
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "secret");
  char** const prefixes = VSIGetFileSystemsPrefixes();
  int checked = 0;
  for (char** prefix = prefixes; *prefix; ++prefix) {
    if (std::string(*prefix) == "/vsimem/") continue;
    ++checked;
    for (const std::string& rest :
         std::vector<std::string>{std::string("http://127.0.0.1:1/x"), (folder / "a.txt").string(),
                                  std::string("0_10,") + (folder / "a.txt").string(), std::string()}) {
      VSILFILE* const file = VSIFOpenL((*prefix + rest).c_str(), "rb");
      EXPECT_EQ(file, nullptr) << *prefix << rest;
      if (file) VSIFCloseL(file);
    }
  }
  CSLDestroy(prefixes);
  EXPECT_GT(checked, 30);
  CPLErrorReset();
}

TEST(Containment, NamesThatMeanOtherThings) {
  const Listener listener;
  const TemporaryFolder folder;
  make_tiff(folder / "secret.tif");
  const Canary canary(folder / "secret.tif");
  const std::string secret = canary.path().string();
  for (const std::string& name : std::vector<std::string>{
           listener.url(),
           listener.url("ftp"),
           "/vsicurl/" + listener.url(),
           "/vsicurl?url=" + listener.url(),
           "/vsis3/bucket/key",
           std::string("/vsicurl_streaming/") + listener.url(),
           "/vsisubfile/0_1000," + secret,
           "/vsigzip/" + secret,
           "/vsizip/" + secret,
           "GTIFF_DIR:1:" + secret,
           "GTIFF_DIR:off:8:" + secret,
           std::string("PG:host=127.0.0.1 dbname=x"),
           "NETCDF:\"" + listener.url() + "\":band",
           std::string("MEM:::DATAPOINTER=1,PIXELS=100,LINES=100"),
           "WMS:" + listener.url(),
           "WFS:" + listener.url(),
           "ZARR:\"" + listener.url() + "\"",
           "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>" + listener.url() + "</ServerUrl></Service></GDAL_WMS>",
           vrt_of(secret),
           "vrt://" + secret,
           std::string("{\"type\":\"Point\",\"coordinates\":[1,1]}"),
           std::string("ESRIJSON:") + listener.url(),
           std::string(),
           std::string("\0x", 2),
           std::string("/dev/zero"),
           std::string("/dev/stdin"),
           folder.path().string()}) {
    for (const bool vector : {false, true}) {
      const auto field = vector ? vector_field(name, config::VectorMeasure::inside) : raster_field(name);
      EXPECT_NE(config_error(local, {field}), "") << name;
    }
  }
  EXPECT_FALSE(canary.was_opened());
  EXPECT_FALSE(listener.was_called());
}

TEST(Containment, AVrtInEveryDisguise) {
  const Listener listener;
  const TemporaryFolder folder;
  make_tiff(folder / "secret.tif");
  const Canary canary(folder / "secret.tif");
  const std::string python =
      R"(<VRTDataset rasterXSize="1" rasterYSize="1"><VRTRasterBand dataType="Byte" band="1" subClass="VRTDerivedRasterBand"><PixelFunctionLanguage>Python</PixelFunctionLanguage><PixelFunctionType>f</PixelFunctionType><PixelFunctionCode><![CDATA[open(')" +
      (folder / "written").string() + R"(','w')]]></PixelFunctionCode></VRTRasterBand></VRTDataset>)";
  for (const std::string& text :
       {vrt_of(canary.path().string()), vrt_of("/vsicurl/" + listener.url()), vrt_of(listener.url()), python,
        std::string("<VRTDataset rasterXSize=\"2000000000\" rasterYSize=\"2000000000\"/>"),
        "<OGRVRTDataSource><OGRVRTLayer name=\"a\"><SrcDataSource>" + canary.path().string() +
            "</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>"}) {
    for (const char* const name : {"a.vrt", "a.tif", "a.asc", "a.png", "a.xml", "a", "a.geojson", "a.gpkg", "a.csv",
                                   "a.shp", "a.img", "a.dt0", "N04E033.hgt"}) {
      write_text(folder / name, text);
      for (const bool vector : {false, true}) {
        const auto field =
            vector ? vector_field(folder / name, config::VectorMeasure::inside) : raster_field(folder / name);
        EXPECT_NE(message_of(local, field), "") << name;
      }
      std::filesystem::remove(folder / name);
    }
  }
  EXPECT_FALSE(canary.was_opened());
  EXPECT_FALSE(listener.was_called());
  EXPECT_FALSE(std::filesystem::exists(folder / "written"));
}

TEST(Containment, OverviewsThatLieElsewhere) {
  const Listener listener;
  const TemporaryFolder folder;
  make_tiff(folder / "secret.tif");
  write_text(folder / "secret.vrt", vrt_of((folder / "secret.tif").string()));
  const Canary canary(folder / "secret.tif"), other(folder / "secret.vrt");
  int number = 0;
  for (const std::string& elsewhere :
       {canary.path().string(), other.path().string(), std::string(":::BASE:::secret.tif"),
        vrt_of(canary.path().string()), vrt_of("/vsicurl/" + listener.url()), "/vsicurl/" + listener.url(),
        "/vsicurl?url=" + listener.url(), listener.url(), "NETCDF:" + listener.url(),
        std::string("MEM:::DATAPOINTER=1,PIXELS=100,LINES=100"), "WMS:" + listener.url(),
        std::string("PG:host=127.0.0.1")}) {
    const auto path = folder / ("t" + std::to_string(number++) + ".tif");
    make_tiff_with_overviews(path, elsewhere);
    // Cut, warped, as classes, and with what asks for masks: none of it needs an overview.
    auto field = raster_field(path);
    EXPECT_EQ(message_of(local, field), "");
    field.crs = "EPSG:32633";
    EXPECT_EQ(message_of(scene_of("EPSG:3035"), field), "");
    field.crs = "";
    field.kind = config::FieldKind::class_code;
    EXPECT_EQ(message_of(local, field), "");
    // The same through the file beside it.
    make_tiff(folder / "plain.tif");
    write_text(folder / "plain.tif.aux.xml", "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">" +
                                                 (elsewhere.starts_with("<") ? std::string("a.vrt") : elsewhere) +
                                                 "</MDI></Metadata></PAMDataset>");
    EXPECT_EQ(message_of(local, raster_field(folder / "plain.tif")), "");
  }
  EXPECT_FALSE(canary.was_opened());
  EXPECT_FALSE(other.was_opened());
  EXPECT_FALSE(listener.was_called());
}

TEST(Containment, ACrsIsNoAddressAndNoFile) {
  const Listener listener;
  const TemporaryFolder folder;
  make_tiff(folder / "a.tif");
  write_text(folder / "crs.wkt", "PROJCS[\"x\"]");
  const Canary canary(folder / "crs.wkt");
  for (const std::string& text :
       {listener.url(), listener.url("https"), "/vsicurl/" + listener.url(), canary.path().string(),
        "ESRI::" + canary.path().string(), std::string("IGNF:/etc/passwd"), "+init=" + canary.path().string() + ":1",
        "+proj=utm +zone=33 +nadgrids=" + canary.path().string(), std::string("urn:ogc:def:crs:EPSG::999999"),
        std::string(100000, '[')}) {
    EXPECT_NE(config_error(scene_of(text, base::Box{0, 0, 10, 10}), {}), "") << text;
    auto field = raster_field(folder / "a.tif");
    field.crs = text;
    EXPECT_NE(config_error(scene_of("EPSG:32633", base::Box{0, 0, 10, 10}), {field}), "") << text;
  }
  // Inside files: a GeoJSON that links to its CRS, a .prj that names one.
  write_text(
      folder / "link.geojson",
      R"({"type":"FeatureCollection","crs":{"type":"link","properties":{"href":")" + listener.url() +
          R"(","type":"proj4"}},"features":[{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[15,0.001]}}]})");
  message_of(scene_of("EPSG:32633", base::Box{500000, 0, 501000, 1000}),
             vector_field(folder / "link.geojson", config::VectorMeasure::inside));
  write_text(
      folder / "name.geojson",
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" + listener.url() +
          R"("}},"features":[{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[15,0.001]}}]})");
  message_of(scene_of("EPSG:32633", base::Box{500000, 0, 501000, 1000}),
             vector_field(folder / "name.geojson", config::VectorMeasure::inside));
  write_grid(folder / "grid.asc", 2, 2, 0, 0, 10, {1, 2, 3, 4});
  write_text(folder / "grid.prj", listener.url());
  message_of(local, raster_field(folder / "grid.asc"));
  EXPECT_FALSE(canary.was_opened());
  EXPECT_FALSE(listener.was_called());
}

// PROJ would open these while GDAL still reads the text. Blanks, brackets and quotation marks may be written in many ways.
TEST(Containment, ACrsNamesNoFileInAnySpelling) {
  const TemporaryFolder folder;
  write_text(folder / "grid", "NTv2");
  const Canary canary(folder / "grid");
  const std::string grid = canary.path().string();
  const std::string degrees = R"(CS[ellipsoidal,2],AXIS["lat",north],AXIS["lon",east],ANGLEUNIT["degree",0.01745]])";
  const auto bound = [&](const std::string& file) {
    return R"(BOUNDCRS[SOURCECRS[GEOGCRS["x",DATUM["d",ELLIPSOID["GRS 1980",6378137,298.257]],)" + degrees +
           R"(],TARGETCRS[GEOGCRS["y",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563]],)" +
           degrees + R"(],ABRIDGEDTRANSFORMATION["t",METHOD["NTv2",ID["EPSG",9615]],)" + file + "]]";
  };
  const std::string name = "\"Latitude and longitude difference file\"";
  for (const std::string& text :
       {bound("PARAMETERFILE[" + name + ",\"" + grid + "\"]"), bound("PARAMETERFILE [" + name + ",\"" + grid + "\"]"),
        bound("parameterfile\n(" + name + ",\"" + grid + "\")"), bound("PARAMETERFILE[\"]\",\"" + grid + "\"]"),
        bound("PARAMETERFILE[\u201C]\u201D,\u201C" + grid + "\u201D]"),
        bound("METHOD[\"PROJ-based operation method: +proj=defmodel +model = " + grid + "\"]"),
        R"(GEOGCS["y",DATUM["d",SPHEROID["GRS 1980",6378137,298.257],EXTENSION ["PROJ4_GRIDS",")" + grid +
            R"("]],PRIMEM["Greenwich",0],UNIT["degree",0.01745]])",
        "+proj=longlat +ellps=GRS80 +nadgrids =\t" + grid + " +type=crs", "+init = " + grid + ":1",
        "+proj=longlat +ellps=GRS80 +nadgrids=\"@a b," + grid + "\"",
        std::string(R"( {"type":"GeographicCRS","name":"x"})")}) {
    EXPECT_THROW(crs_from_text(text), base::Error) << text;
  }
  EXPECT_FALSE(canary.was_opened());
  // A grid that PROJ looks for in its own folder may be named, and nothing is said on standard error where it lacks.
  testing::internal::CaptureStderr();
  const Crs own = crs_from_text(bound("PARAMETERFILE[" + name + ",\"no_such_grid.gsb\"]"));
  EXPECT_EQ(name_of(own), "x");
  EXPECT_TRUE(is_geographic(own));
  bounds(Transformation(own, wgs84()), {1, 1, 2, 2});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NO_THROW(crs_from_text("EPSG:3857"));
}

TEST(Containment, NoRequestLeavesThroughGdal) {
  prepare_gdal();
  const Listener listener;
  CPLHTTPResult* const result = CPLHTTPFetch(listener.url().c_str(), nullptr);
  ASSERT_TRUE(result);
  EXPECT_NE(result->nStatus, 0);
  CPLHTTPDestroyResult(result);
  EXPECT_FALSE(listener.was_called());
}

TEST(Containment, ClaimsThatCannotBeTrue) {
  const TemporaryFolder folder;
  prepare_gdal();
  // 10^12 cells, stored nowhere.
  {
    const char* const options[] = {"SPARSE_OK=TRUE", "TILED=YES", "BLOCKXSIZE=8192", "BLOCKYSIZE=8192", nullptr};
    const Dataset dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        (folder / "sparse.tif").c_str(), 1000000, 1000000, 1, GDT_Byte, const_cast<char**>(options)));
    ASSERT_TRUE(dataset);
    double transform[6] = {0, 1, 0, 1000000, 0, -1};
    dataset->SetGeoTransform(transform);
  }
  EXPECT_NE(config_error(local, {raster_field(folder / "sparse.tif")}).find("claims 1000000 x 1000000 cells, but has"),
            std::string::npos);
  EXPECT_NE(config_error({}, {raster_field(folder / "sparse.tif", true)}).find("claims 1000000 x 1000000 cells"),
            std::string::npos);

  // A PNG of a few bytes that claims 60000 squared (with the right checksum of its header).
  const unsigned char png[] = {0x89, 'P', 'N', 'G',  '\r', '\n', 0x1a, '\n', 0,    0, 0, 13, 'I', 'H', 'D',
                               'R',  0,   0,   0xea, 0x60, 0,    0,    0xea, 0x60, 8, 0, 0,  0,   0};
  std::string text(reinterpret_cast<const char*>(png), sizeof png);
  unsigned crc = 0xffffffffu;
  for (std::size_t i = 12; i < text.size(); ++i) {
    crc ^= static_cast<unsigned char>(text[i]);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  crc = ~crc;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(crc >> shift);
  text += std::string("\0\0\0\0IDAT\x35\xaf\x06\x1e\0\0\0\0IEND\xae\x42\x60\x82", 24);
  write_text(folder / "bomb.png", text);
  EXPECT_NE(config_error(local, {raster_field(folder / "bomb.png")}).find("claims 60000 x 60000 cells"),
            std::string::npos)
      << config_error(local, {raster_field(folder / "bomb.png")});

  // A grid of text whose header promises more than there is.
  write_text(folder / "grid.asc", "ncols 2000000000\nnrows 2000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
  EXPECT_NE(config_error(local, {raster_field(folder / "grid.asc")}), "");
}

TEST(Containment, PlacesThatAreNoFiles) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe.tif").c_str(), 0600), 0);
  EXPECT_NE(config_error(local, {raster_field(folder / "pipe.tif")}).find("no regular file"), std::string::npos);
  EXPECT_NE(
      config_error(local, {vector_field(folder / "pipe.tif", config::VectorMeasure::inside)}).find("no regular file"),
      std::string::npos);
  EXPECT_NE(config_error(local, {raster_field(folder.path())}).find("is a folder"), std::string::npos);
  make_tiff(folder / "real.tif");
  std::filesystem::create_symlink(folder / "real.tif", folder / "link.tif");
  EXPECT_EQ(config_error(local, {raster_field(folder / "link.tif")}), "") << "a user's own link is followed";
  std::filesystem::create_symlink(folder / "loop.tif", folder / "loop.tif");
  EXPECT_NE(config_error(local, {raster_field(folder / "loop.tif")}), "");
}

// A GeoPackage with one honest layer; then SQL is run on it.
void make_geopackage(const std::filesystem::path& path, const std::string& sql) {
  std::vector<double> x = {10, 20}, y = {10, 20};
  PointLayer layer;
  layer.name = "honest";
  bool first = true;
  write_points(path, PointFormat::geopackage, layer, [&]() -> std::optional<PointBlock> {
    if (!first) return std::nullopt;
    first = false;
    return PointBlock{x, y, {}};
  });
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &connection), SQLITE_OK);
  char* problem = nullptr;
  ASSERT_EQ(sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, &problem), SQLITE_OK) << problem;
  sqlite3_close(connection);
}

const std::string registered =
    "INSERT INTO gpkg_contents (table_name, data_type, identifier, min_x, min_y, max_x, max_y, srs_id) VALUES ('evil', "
    "'features', 'evil', 0, 0, 1000, 1000, 0);"
    "INSERT INTO gpkg_geometry_columns VALUES ('evil', 'geom', 'POINT', 0, 0, 0);";

// What GDAL itself reads of a CRS: a GeoPackage's table, in any encoding, and a shapefile's .prj.
TEST(Containment, ACrsInAFileNamesNoFile) {
  const TemporaryFolder folder;
  write_text(folder / "grid", "NTv2");
  const Canary canary(folder / "grid");
  const std::string degrees = R"(CS[ellipsoidal,2],AXIS["lat",north],AXIS["lon",east],ANGLEUNIT["degree",0.01745]])";
  const std::string crs =
      R"(BOUNDCRS[SOURCECRS[GEOGCRS["x",DATUM["d",ELLIPSOID["GRS 1980",6378137,298.257]],)" + degrees +
      R"(],TARGETCRS[GEOGCRS["y",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563]],)" +
      degrees + R"(],ABRIDGEDTRANSFORMATION["t",METHOD["NTv2",ID["EPSG",9615]],ParameterFile ["f",")" +
      canary.path().string() + "\"]]]";
  make_geopackage(folder / "evil.gpkg", "UPDATE gpkg_spatial_ref_sys SET organization = 'NONE', definition = '" + crs +
                                            "'; UPDATE gpkg_contents SET srs_id = (SELECT min(srs_id) FROM "
                                            "gpkg_spatial_ref_sys);");
  EXPECT_NE(
      config_error(local, {vector_field(folder / "evil.gpkg", config::VectorMeasure::inside)}).find("PARAMETERFILE"),
      std::string::npos);
  write_text(folder / "points.csv", "x,y\n1,1\n");
  write_text(folder / "points.prj", crs);
  EXPECT_NE(
      config_error(local, {vector_field(folder / "points.csv", config::VectorMeasure::inside)}).find("PARAMETERFILE"),
      std::string::npos);
  EXPECT_FALSE(canary.was_opened());
  // Other talk of parameter files is no CRS, nor does a place where two pieces of a file meet hide one.
  EXPECT_FALSE(holds_parameter_file("\"ParameterFile\": \"/etc/passwd\""));
  for (const char* const text : {R"(\u0050arameterfile["f","/x"])", R"(P\u0041RAMETER\u0046ile\n[)",
                                 "&#80;ARAMETERFILE[", "PARAMETER&#x46;ile (", R"(ParameterFile\t\u005B)"}) {
    EXPECT_TRUE(holds_parameter_file(text)) << text;
  }
  for (const char* const text : {"\\u", "\\u00", "&#", "&#;", "&#x;", "&#99999999999999;", "\\"}) {
    EXPECT_FALSE(holds_parameter_file(text)) << text;
  }
  for (const int before : {0, 1, 255, 256, 257, (1 << 20) - 7, (1 << 20) - 1, 1 << 20}) {
    write_text(folder / "long.prj", std::string(static_cast<std::size_t>(before), ' ') + crs);
    EXPECT_THROW(refuse_parameter_files(folder / "long.csv"), base::Error) << before;
  }
}

TEST(Containment, GeoPackageViewsWithoutEnd) {
  const TemporaryFolder folder;
  const std::string endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) ";
  const std::vector<std::string> attacks = {
      "CREATE VIEW evil AS " + endless + "SELECT i AS fid, NULL AS geom, i AS a FROM n WHERE i < 0;" + registered,
      "CREATE VIEW evil AS " + endless + "SELECT count(*) AS fid, NULL AS geom FROM n;" + registered,
      "CREATE VIEW evil AS SELECT fid, geom FROM honest WHERE (SELECT count(*) FROM (" + endless +
          "SELECT i FROM n)) > 0;" + registered,
      "ALTER TABLE gpkg_spatial_ref_sys RENAME TO real_srs; CREATE VIEW gpkg_spatial_ref_sys AS " + endless +
          "SELECT real_srs.* FROM real_srs, n WHERE i < 0;",
      "ALTER TABLE gpkg_geometry_columns RENAME TO real_columns; CREATE VIEW gpkg_geometry_columns AS " + endless +
          "SELECT real_columns.* FROM real_columns, n WHERE i < 0;",
  };
  for (std::size_t k = 0; k < attacks.size(); ++k) {
    for (const char* const layer : {"evil", "honest", ""}) {
      const auto path = folder / ("a" + std::to_string(k) + ".gpkg");
      make_geopackage(path, attacks[k]);
      auto field = vector_field(path, config::VectorMeasure::inside);
      field.crs = "local";
      field.layer = layer;
      const auto start = std::chrono::steady_clock::now();
      const std::string message = message_of(local, field);
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      EXPECT_LT(seconds, 100) << "hangs";
      if (std::string(layer) == "evil") {
        EXPECT_NE(message, "");
      }
    }
  }
}

TEST(Containment, GeoPackageViewsThatCallOut) {
  const Listener listener;
  const TemporaryFolder folder;
  make_tiff(folder / "secret.tif");
  const Canary canary(folder / "secret.tif");
  int number = 0;
  for (const std::string& call : std::vector<std::string>{
           "load_extension('/tmp/evil.so')", "ogr_geocode('x', 'geometry', '{}')",
           "ogr_datasource_load_layers('SECRET')", "gdal_get_pixel_value('SECRET', 1, 'pixel', 0, 0)",
           "ogr_SetConfigOption('GDAL_DRIVER_PATH', '/tmp')", "hex(zeroblob(1000000000))"}) {
    std::string text = call;
    if (const auto at = text.find("SECRET"); at != std::string::npos) text.replace(at, 6, canary.path().string());
    const auto path = folder / ("c" + std::to_string(number++) + ".gpkg");
    make_geopackage(path, "CREATE VIEW evil AS SELECT fid, geom, " + text + " AS a FROM honest;" + registered);
    auto field = vector_field(path, config::VectorMeasure::inside);
    field.crs = "local";
    field.layer = "evil";
    message_of(local, field);
    field.layer = "honest";
    field.where = text + " IS NULL OR 1";
    message_of(local, field);
  }
  EXPECT_FALSE(canary.was_opened());
  EXPECT_FALSE(listener.was_called());
  EXPECT_EQ(CPLGetConfigOption("GDAL_DRIVER_PATH", nullptr), nullptr);
}

// An honest view is an honest layer.
// A few bytes of SQL that ask for room without bound.
TEST(Containment, GeoPackageFunctionsThatSwell) {
  const TemporaryFolder folder;
  make_geopackage(folder / "a.gpkg", "");
  auto field = vector_field(folder / "a.gpkg", config::VectorMeasure::inside);
  field.crs = "local";
  field.layer = "honest";
  for (const std::string& call : std::vector<std::string>{
           "printf('%.*c', 200000000, 'x')", "format('%.*c', 200000000, 'x')", "hex(zeroblob(100000000))",
           "replace(hex(replace('" + std::string(1000, 'x') + "', 'x', '" + std::string(1000, 'y') + "')), '7', '" +
               std::string(100, 'z') + "')"}) {
    field.where = "length(" + call + ") > 0";
    EXPECT_NE(config_error(local, {field}), "") << call.substr(0, 60);
  }
  field.where = "fid > 0";
  EXPECT_EQ(config_error(local, {field}), "");
}

TEST(Containment, HonestGeoPackageViewsAreRead) {
  const TemporaryFolder folder;
  make_geopackage(folder / "view.gpkg", "CREATE VIEW evil AS SELECT fid, geom FROM honest WHERE fid > 1;" + registered);
  auto field = vector_field(folder / "view.gpkg", config::VectorMeasure::inside);
  field.crs = "local";
  field.layer = "evil";
  field.resolution_m = 1;
  const FieldSet set = load_fields(local, {field});
  EXPECT_EQ(sample_at(set.fields[0], 20.5, 19.5).value, 1);
  EXPECT_EQ(sample_at(set.fields[0], 10.5, 9.5).value, 0);
}

TEST(Containment, NothingIsWrittenBesideTheInputs) {
  NEED_SHARED("nc_wake/lakes.shp");
  const TemporaryFolder folder;
  for (const char* const name :
       {"lakes.shp", "lakes.shx", "lakes.dbf", "lakes.prj", "elev_ned_30m.tif", "water_polygons_from_landuse.gpkg"}) {
    std::filesystem::copy_file(shared(std::string("nc_wake/") + name), folder / name);
  }
  load_fields({}, {raster_field(folder / "elev_ned_30m.tif", true),
                   vector_field(folder / "lakes.shp", config::VectorMeasure::inside),
                   vector_field(folder / "water_polygons_from_landuse.gpkg", config::VectorMeasure::distance)});
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files, (void)entry;
  EXPECT_EQ(files, 6);
}

}  // namespace
}  // namespace silvasim::fields
