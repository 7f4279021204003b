// Files that are made to do harm: nothing is fetched, nothing expands, nothing crashes.
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <array>
#include <fstream>
#include <string>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/sources/source.h"
#include "mars/vector/feature_reader.h"
#include "mars/vector/xml_guard.h"
#include "tests/mars/vector/vector_files.h"
#include "tests/support/http_server.h"
#include "tests/support/support.h"

namespace {

using vector_files::collection;
using vector_files::expect_words;
using vector_files::feature;
using vector_files::read;
using vector_files::read_error;
using vector_files::read_text;
using vector_files::translate;
using vector_files::write_text;
using vector_files::write_zip;

const std::string kPointOneTwo = R"({"type":"Point","coordinates":[1,2]})";
const std::string kKml = "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>";
const std::string kPlacemark = "<Placemark><Point><coordinates>1,2</coordinates></Point></Placemark>";
const std::string kKmlEnd = "</Document></kml>";

class HostileVector : public ::testing::Test {
 protected:
  std::string kml_error(const std::string& text) const {
    write_text(folder_ / "h.kml", text);
    return read_error(folder_ / "h.kml");
  }

  test_support::TempDir folder_;
};

TEST_F(HostileVector, BillionLaughs) {
  std::string laughs = "<?xml version=\"1.0\"?>\n<!-- - --><!DOCTYPE kml [<!ENTITY a \"ha\">";
  for (char c = 'b'; c < 'n'; ++c) {
    laughs += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 10; ++i) laughs += std::string("&") + static_cast<char>(c - 1) + ";";
    laughs += "\">";
  }
  laughs += "]>";
  expect_words(kml_error(laughs + kKml + "<name>&m;</name>" + kPlacemark + kKmlEnd),
               {"h.kml", "<!DOCTYPE", "remove it"});
  write_text(folder_ / "h.gpx", laughs + "<gpx><wpt lat=\"1\" lon=\"2\"><name>&m;</name></wpt></gpx>");
  expect_words(read_error(folder_ / "h.gpx"), {"h.gpx", "<!DOCTYPE"});
  write_zip(folder_ / "h.kmz", {{"doc.kml", laughs + kKml + "&m;" + kKmlEnd}});
  expect_words(read_error(folder_ / "h.kmz"), {"h.kmz", "doc.kml", "<!DOCTYPE"});
  // The same as UTF-16, where the words are not found.
  std::string wide = "\xff\xfe";
  for (const char c : laughs + kKml + kKmlEnd) wide += {c, '\0'};
  expect_words(kml_error(wide), {"h.kml", "UTF-8"});
  expect_words(kml_error(wide.substr(2)), {"h.kml", "UTF-8"});
}

TEST_F(HostileVector, InspectsXml) {
  EXPECT_EQ(mars::inspect_xml("<a b='>'><!-- <!DOCTYPE x> --><![CDATA[<!DOCTYPE y>]]></a>").problem, "");
  EXPECT_NE(mars::inspect_xml("<?x <!?><!DOCTYPE z><a/>").problem, "");
  EXPECT_EQ(mars::inspect_xml("").problem, "");
  EXPECT_EQ(mars::inspect_xml("<").problem, "");
  std::string deep;
  for (int i = 0; i < mars::kMostXmlDepth; ++i) deep += "<a>";
  EXPECT_EQ(mars::inspect_xml(deep).problem, "");
  EXPECT_NE(mars::inspect_xml(deep + "<a>").problem, "");
  EXPECT_EQ(mars::inspect_xml(deep + "<a/>").problem, "");
  const auto links =
      mars::inspect_xml(
          "<k:NetworkLink><Link><href> <![CDATA[a.kml]]></href></Link></k:NetworkLink><href>b</href>"
          "<NetworkLink/><NetworkLink><name>n</name></NetworkLink>")
          .links;
  EXPECT_EQ(links, (std::vector<std::string>{"a.kml", "", ""}));
}

TEST_F(HostileVector, DeepNesting) {
  std::string deep = kKml;
  for (int i = 0; i < 100'000; ++i) deep += "<Folder>";
  expect_words(kml_error(deep), {"h.kml", "nested more than 100 deep"});
  const std::string brackets(200'000, '[');
  write_text(folder_ / "deep.json",
             collection({feature(R"({"type":"LineString","coordinates":)" + brackets + "}")}));
  expect_words(read_error(folder_ / "deep.json"), {"deep.json"});
  std::string nested;
  for (int i = 0; i < 20'000; ++i) nested += R"({"type":"GeometryCollection","geometries":[)";
  write_text(folder_ / "nested.json", collection({feature(nested)}));
  expect_words(read_error(folder_ / "nested.json"), {"nested.json"});
  std::string wkt = "WKT,a\n\"";
  for (int i = 0; i < 20'000; ++i) wkt += "GEOMETRYCOLLECTION(";
  write_text(folder_ / "nested.csv", wkt + "\",1\n");
  expect_words(read_error(folder_ / "nested.csv"), {"nested.csv", "feature 1"});
}

TEST_F(HostileVector, ZipBomb) {
  const std::string spaces(std::size_t{16} << 20, ' ');
  write_zip(folder_ / "bomb.kmz", {{"doc.kml", kKml + spaces + kPlacemark + kKmlEnd}});
  ASSERT_LT(std::filesystem::file_size(folder_ / "bomb.kmz"), std::size_t{1} << 20);
  mars::FeatureReadOptions options;
  options.most_bytes = std::size_t{4} << 20;
  expect_words(read_error(folder_ / "bomb.kmz", options),
               {"bomb.kmz", "unpacks to more than the 4194304 bytes"});
  // Every document is small, all together are not.
  const std::string part(std::size_t{3} << 20, ' ');
  write_zip(folder_ / "parts.kmz",
            {{"doc.kml", kKml + "<NetworkLink><Link><href>b.kml</href></Link></NetworkLink>" + part + kKmlEnd},
             {"b.kml", kKml + part + kPlacemark + kKmlEnd}});
  expect_words(read_error(folder_ / "parts.kmz", options), {"parts.kmz", "'b.kml'", "unpacks to more"});
  options.most_bytes = std::size_t{8} << 20;
  EXPECT_EQ(read_error(folder_ / "parts.kmz", options), "");
}

TEST_F(HostileVector, ZipWithFalseSizes) {
  const std::string spaces(std::size_t{1} << 20, ' ');
  write_zip(folder_ / "f.kmz", {{"doc.kml", kKml + spaces + kPlacemark + kKmlEnd}});
  const std::string zip = read_text(folder_ / "f.kmz");
  const std::size_t directory = zip.find("PK\x01\x02");
  ASSERT_NE(directory, std::string::npos);
  for (const std::size_t field : {20U, 24U}) {
    for (const std::string& size :
         {std::string("\0\0\0\0", 4), std::string("\x10\0\0\0", 4), std::string("\xff\xff\xff\x7f", 4)}) {
      std::string changed = zip;
      changed.replace(directory + field, 4, size);
      write_text(folder_ / "f.kmz", changed);
      mars::FeatureReadOptions options;
      options.most_bytes = std::size_t{8} << 20;
      read_error(folder_ / "f.kmz", options);
    }
  }
}

TEST_F(HostileVector, LinksOutOfAFileAreRefused) {
  for (const char* href :
       {"http://127.0.0.1:1/x.kml", "../../etc/x.kml", "/etc/x.kml", "missing.kml", "style.xml", ""}) {
    SCOPED_TRACE(href);
    const std::string link = std::string("<NetworkLink><Link><href>") + href + "</href></Link></NetworkLink>";
    expect_words(kml_error(kKml + link + kPlacemark + kKmlEnd), {"h.kml", "<NetworkLink>", "not followed"});
    write_zip(folder_ / "l.kmz", {{"doc.kml", kKml + link + kPlacemark + kKmlEnd}});
    expect_words(read_error(folder_ / "l.kmz"), {"l.kmz", "<NetworkLink>"});
  }
  // In circles within the archive.
  write_zip(folder_ / "c.kmz",
            {{"doc.kml", kKml + "<NetworkLink><Link><href>d/b.kml</href></Link></NetworkLink>" + kKmlEnd},
             {"d/b.kml", kKml + "<NetworkLink><Link><href>../doc.kml</href></Link></NetworkLink>" + kPlacemark +
                             kKmlEnd}});
  EXPECT_EQ(read(folder_ / "c.kmz").size(), 1U);
}

TEST_F(HostileVector, NamesOfServersAndDrivers) {
  for (const char* name :
       {"http://127.0.0.1:1/a.geojson", "https://x.org/a.kml", "/vsicurl/http://127.0.0.1:1/a.geojson",
        "/vsizip/a.zip/a.shp", "/vsistdin/a.json", "/vsimem/a.json"}) {
    expect_words(read_error(name), {name, "not read from servers"});
  }
  for (const char* name : {"PG:dbname=x", "GPKG:a.gpkg:t", "GeoJSON:a.json", "SELECT 1", "<OGRVRTDataSource/>",
                           R"({"type":"FeatureCollection","features":[]}.json)", "CSV:x.csv", "MYSQL:x.csv"}) {
    expect_words(read_error(name), {name});
  }
  const std::string vrt = "<OGRVRTDataSource><OGRVRTLayer name=\"a\"><SrcDataSource>" +
                          (folder_ / "a.json").string() + "</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>";
  write_text(folder_ / "a.json", collection({feature(kPointOneTwo)}));
  for (const char* name : {"v.gpkg", "v.geojson", "v.shp", "v.kml", "v.gpx"}) {
    write_text(folder_ / name, vrt);
    expect_words(read_error(folder_ / name), {name});
  }
  write_text(folder_ / "v.vrt", vrt);
  expect_words(read_error(folder_ / "v.vrt"), {"v.vrt", "extension"});
}

TEST_F(HostileVector, NothingIsFetched) {
  std::filesystem::create_directory(folder_ / "served");
  write_text(folder_ / "served" / "x",
             "GEOGCS[\"x\",DATUM[\"d\",SPHEROID[\"s\",3396190,0]],PRIMEM[\"G\",0],"
             "UNIT[\"degree\",0.0174532925199433]]");
  const test_support::HttpServer server(folder_ / "served");
  const std::string url = server.url("x");
  const auto crs = [&](const std::string& member) {
    write_text(folder_ / "n.json", R"({"type":"FeatureCollection","crs":)" + member + R"(,"features":[)" +
                                       feature(kPointOneTwo) + "]}");
    return read_error(folder_ / "n.json");
  };
  EXPECT_NE(crs(R"({"type":"link","properties":{"href":")" + url + R"("}})"), "");
  EXPECT_NE(crs(R"({"type":"URL","properties":{"url":")" + url + R"("}})"), "");
  EXPECT_NE(crs(R"({"type":"name","properties":{"name":")" + url + R"("}})"), "");
  EXPECT_NE(crs(R"({"type":"name","properties":{"name":"/vsicurl/)" + url + R"("}})"), "");
  EXPECT_EQ(
      kml_error(kKml + "<Placemark><styleUrl>" + url + "#s</styleUrl><Style><IconStyle><Icon><href>" + url +
                "</href></Icon></IconStyle></Style><Point><coordinates>1,2</coordinates></Point></Placemark>" +
                kKmlEnd),
      "");
  EXPECT_EQ(server.requests(), 0);
}

TEST_F(HostileVector, ViewsOfADatabaseCallNothing) {
  write_text(folder_ / "a.json", collection({feature(kPointOneTwo)}));
  ASSERT_TRUE(translate(folder_ / "a.json", folder_ / "v.gpkg", {"-f", "GPKG", "-nln", "t"}));
  {
    const mars::GdalScope scope;
    GDALDataset* dataset = GDALDataset::Open((folder_ / "v.gpkg").c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE);
    ASSERT_NE(dataset, nullptr);
    for (
        const char* sql :
        {"CREATE VIEW v AS SELECT fid, geom, ST_MinX(geom) AS w FROM t",
         "INSERT INTO gpkg_contents (table_name, data_type, identifier, srs_id) VALUES ('v', 'features', 'v', 4326)",
         "INSERT INTO gpkg_geometry_columns VALUES ('v', 'geom', 'POINT', 4326, 0, 0)"}) {
      dataset->ReleaseResultSet(dataset->ExecuteSQL(sql, nullptr, nullptr));
    }
    EXPECT_EQ(scope.message(), "");
    GDALClose(dataset);
  }
  {
    // GDAL alone calls it.
    const mars::GdalScope scope;
    GDALDataset* dataset = GDALDataset::Open((folder_ / "v.gpkg").c_str(), GDAL_OF_VECTOR);
    ASSERT_NE(dataset, nullptr);
    EXPECT_NE(OGRFeatureUniquePtr(dataset->GetLayerByName("v")->GetNextFeature()), nullptr);
    GDALClose(dataset);
  }
  expect_words(read_error(folder_ / "v.gpkg"), {"v.gpkg", "layer 'v'", "failed to prepare SQL"});
  mars::FeatureReadOptions options;
  options.layer = "t";
  EXPECT_EQ(read_error(folder_ / "v.gpkg", options), "");
}

// Changes bytes, cuts, repeats and exchanges parts.
std::string mutated(std::string text, test_support::Random& random) {
  const auto place = [&] {
    return static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
  };
  const int changes = random.integer(1, 6);
  for (int i = 0; i < changes && text.size() > 2; ++i) {
    const std::size_t at = place();
    switch (random.integer(0, 4)) {
      case 0: text[at] = static_cast<char>(random.integer(0, 255)); break;
      case 1: text[at] = static_cast<char>(text[at] ^ (1 << random.integer(0, 7))); break;
      case 2: text.resize(at + 1); break;
      case 3: text.insert(at, text.substr(place(), static_cast<std::size_t>(random.integer(1, 40)))); break;
      default: text.erase(at, static_cast<std::size_t>(random.integer(1, 20))); break;
    }
  }
  return text;
}

TEST_F(HostileVector, MutatedFilesReadOrAreRefused) {
  write_text(
      folder_ / "a.geojson",
      collection(
          {feature(
               R"({"type":"Polygon","coordinates":[[[10,10],[20,10],[20,20],[10,10]],[[12,12],[13,13],[13,12],[12,12]]]})",
               R"({"name":"a","n":5,"x":0.5})"),
           feature(R"({"type":"Polygon","coordinates":[[[170,10],[-170,10],[-170,20],[170,10]]]})")},
          "urn:ogc:def:crs:IAU_2015::49900"));
  for (const auto& [driver, name] : {std::pair{"GPKG", "b.gpkg"}, std::pair{"ESRI Shapefile", "c.shp"},
                                     std::pair{"LIBKML", "d.kml"}, std::pair{"LIBKML", "e.kmz"}})
    ASSERT_TRUE(translate(folder_ / "a.geojson", folder_ / name, {"-f", driver}));
  write_text(folder_ / "f.gpx",
             "<gpx version=\"1.1\"><wpt lat=\"-4.5\" lon=\"137.4\"><name>L</name></wpt><trk><trkseg>"
             "<trkpt lat=\"1\" lon=\"2\"/><trkpt lat=\"2\" lon=\"3\"/></trkseg></trk></gpx>");
  write_text(folder_ / "g.csv", "name,lon,lat\nA,1,2\nB,3,4\n");
  write_text(folder_ / "h.csv", "WKT,v\n\"POLYGON ((0 0,1 0,1 1))\",1\n");
  // Which file is changed, and which is read.
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.geojson", "a.geojson"}, {"b.gpkg", "b.gpkg"}, {"c.shp", "c.shp"}, {"c.dbf", "c.shp"},
      {"c.shx", "c.shp"},         {"c.prj", "c.shp"},   {"d.kml", "d.kml"}, {"e.kmz", "e.kmz"},
      {"f.gpx", "f.gpx"},         {"g.csv", "g.csv"},   {"h.csv", "h.csv"}};
  test_support::Random random(20261127);
  mars::FeatureReadOptions options;
  options.most_vertices = 100'000;
  options.most_bytes = std::size_t{16} << 20;
  testing::internal::CaptureStderr();
  int read_well = 0;
  int refused = 0;
  for (int i = 0; i < 330; ++i) {
    const auto& [changed, opened] = files[static_cast<std::size_t>(i) % files.size()];
    const std::string whole = read_text(folder_ / changed);
    write_text(folder_ / changed, mutated(whole, random));
    (read_error(folder_ / opened, options).empty() ? read_well : refused) += 1;
    write_text(folder_ / changed, whole);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  RecordProperty("read", read_well);
  RecordProperty("refused", refused);
  EXPECT_GT(read_well, 20);
  EXPECT_GT(refused, 20);
}

}  // namespace
