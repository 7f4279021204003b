// Makes vector files for tests, with GDAL itself or as text, and reads them.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "mars/vector/feature_reader.h"

namespace vector_files {

void write_text(const std::filesystem::path& path, const std::string& text);
std::string read_text(const std::filesystem::path& path);

// Converts a file as the program ogr2ogr does with these arguments. Returns whether GDAL did it.
bool translate(const std::filesystem::path& from, const std::filesystem::path& to,
               const std::vector<std::string>& arguments);

// Returns the text of a GeoJSON collection of features, each of which is a text. `crs` is the name of a system, or "".
std::string collection(const std::vector<std::string>& features, const std::string& crs = "");
std::string feature(const std::string& geometry, const std::string& properties = "{}");

// Writes files of a ZIP archive.
struct Member {
  std::string name;
  std::string text;
};
void write_zip(const std::filesystem::path& path, const std::vector<Member>& members);

// Reads for Mars.
std::vector<mars::FeatureLayer> read(const std::filesystem::path& path,
                                     const mars::FeatureReadOptions& options = {});

// Returns what() of the SourceError that reading throws, or "" if it reads.
std::string read_error(const std::filesystem::path& path, const mars::FeatureReadOptions& options = {});

// Checks that an error is one line that has all words.
void expect_words(const std::string& message, const std::vector<std::string>& words);

// Returns all vertices of a layer.
std::vector<glm::dvec2> vertices(const mars::FeatureLayer& layer);

}  // namespace vector_files
