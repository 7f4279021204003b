#include "tests/mars/vector/vector_files.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_utils.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/sources/source.h"

namespace vector_files {

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  ASSERT_TRUE(file.flush().good()) << path;
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

bool translate(const std::filesystem::path& from, const std::filesystem::path& to,
               const std::vector<std::string>& arguments) {
  const mars::GdalScope scope;
  CPLStringList list;
  for (const std::string& argument : arguments) list.AddString(argument.c_str());
  GDALVectorTranslateOptions* options = GDALVectorTranslateOptionsNew(list.List(), nullptr);
  GDALDatasetH source = GDALOpenEx(from.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr);
  int failed = 0;
  GDALDatasetH made =
      source == nullptr ? nullptr : GDALVectorTranslate(to.c_str(), nullptr, 1, &source, options, &failed);
  const bool done = made != nullptr && failed == 0;
  if (!done)
    ADD_FAILURE() << from << " to " << to << ": " << scope.message() << (made == nullptr ? " (none)" : "");
  if (made != nullptr) GDALClose(made);
  if (source != nullptr) GDALClose(source);
  GDALVectorTranslateOptionsFree(options);
  return done;
}

std::string collection(const std::vector<std::string>& features, const std::string& crs) {
  std::string text = R"({"type":"FeatureCollection",)";
  if (!crs.empty()) text += R"("crs":{"type":"name","properties":{"name":")" + crs + R"("}},)";
  text += R"("features":[)";
  for (std::size_t i = 0; i < features.size(); ++i) text += (i == 0 ? "" : ",\n") + features[i];
  return text + "]}";
}

std::string feature(const std::string& geometry, const std::string& properties) {
  return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":)" + geometry + "}";
}

void write_zip(const std::filesystem::path& path, const std::vector<Member>& members) {
  const mars::GdalScope scope;
  void* zip = CPLCreateZip(path.c_str(), nullptr);
  ASSERT_NE(zip, nullptr);
  for (const Member& member : members) {
    ASSERT_EQ(CPLCreateFileInZip(zip, member.name.c_str(), nullptr), CE_None);
    ASSERT_EQ(CPLWriteFileInZip(zip, member.text.data(), static_cast<int>(member.text.size())), CE_None);
    ASSERT_EQ(CPLCloseFileInZip(zip), CE_None);
  }
  ASSERT_EQ(CPLCloseZip(zip), CE_None);
}

std::vector<mars::FeatureLayer> read(const std::filesystem::path& path,
                                     const mars::FeatureReadOptions& options) {
  return mars::read_features(path.string(), options, mars::kMarsRadius_m);
}

std::string read_error(const std::filesystem::path& path, const mars::FeatureReadOptions& options) {
  try {
    read(path, options);
  } catch (const mars::SourceError& error) {
    return error.what();
  }
  return {};
}

void expect_words(const std::string& message, const std::vector<std::string>& words) {
  ASSERT_FALSE(message.empty()) << "no error with " << (words.empty() ? "" : words.back());
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << word << " not in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

std::vector<glm::dvec2> vertices(const mars::FeatureLayer& layer) {
  std::vector<glm::dvec2> all;
  for (const mars::Feature& feature : layer.features) {
    for (const mars::Shape& shape : feature.shapes) {
      for (const auto& ring : shape.rings) all.insert(all.end(), ring.begin(), ring.end());
    }
  }
  return all;
}

}  // namespace vector_files
