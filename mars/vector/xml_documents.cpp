#include "mars/vector/xml_documents.h"

#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/vector/xml_guard.h"
#include "vpe/base/file.h"
#include "vpe/base/quote.h"

namespace mars {
namespace {

constexpr std::size_t kPiece_bytes = std::size_t{1} << 20;
constexpr int kMostEntries = 100'000;
constexpr const char* kKmzAdvice = "give a KMZ file that virtual globes open, or the KML file in it";

bool has_ending(const std::string& name, const char* ending) {
  return CPLString(name).tolower().ends_with(ending);
}

SourceError link_error(const std::string& path, const std::string& link) {
  return source_error(path,
                      "it has a <NetworkLink> to " + vpe::base::quote_text(link) + ", which is not followed",
                      "", "save in a virtual globe what the link shows, or remove the link");
}

// Unpacks documents of a KMZ.
class KmzReader {
 public:
  KmzReader(const std::string& path, std::size_t most_bytes)
      : path_(path),
        archive_("/vsizip/{" + std::filesystem::absolute(path).string() + "}"),
        most_bytes_(most_bytes),
        left_(most_bytes) {}

  std::vector<std::string> read() {
    std::vector<std::string> names{document_name()};
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < names.size(); ++i) {
      texts.push_back(unpack(names[i]));
      const XmlFindings findings = inspect_xml(texts.back());
      if (!findings.problem.empty()) throw SourceError(path_ + ": '" + names[i] + "': " + findings.problem);
      for (const std::string& link : findings.links) {
        const std::string target = target_of(names[i], link);
        if (std::ranges::find(names, target) == names.end()) names.push_back(target);
      }
    }
    return texts;
  }

 private:
  std::string document_name() {
    const std::unique_ptr<VSIDIR, void (*)(VSIDIR*)> folder(VSIOpenDir(archive_.c_str(), -1, nullptr),
                                                            [](VSIDIR* d) { VSICloseDir(d); });
    std::string first;
    for (int i = 0; folder && i < kMostEntries; ++i) {
      const VSIDIREntry* entry = VSIGetNextDirEntry(folder.get());
      if (entry == nullptr) break;
      const std::string name = entry->pszName;
      if (CPLString(name).tolower() == "doc.kml") return name;
      if (first.empty() && has_ending(name, ".kml")) first = name;
    }
    if (first.empty()) throw source_error(path_, "no KML file is in it", GdalScope::last_message(), kKmzAdvice);
    return first;
  }

  // Returns the name in the archive that a link of a document leads to.
  std::string target_of(const std::string& document, const std::string& link) const {
    const auto target = (std::filesystem::path(document).parent_path() / link).lexically_normal();
    const std::string name = target.generic_string();
    const bool is_inside = !link.empty() && link.find(':') == std::string::npos && !target.is_absolute() &&
                           !name.starts_with("..") && has_ending(name, ".kml");
    VSIStatBufL stat{};
    if (!is_inside || VSIStatExL((archive_ + "/" + name).c_str(), &stat, VSI_STAT_EXISTS_FLAG) != 0)
      throw link_error(path_, link);
    return name;
  }

  std::string unpack(const std::string& name) {
    const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(VSIFOpenL((archive_ + "/" + name).c_str(), "rb"),
                                                             VSIFCloseL);
    if (!file) throw source_error(path_, "cannot unpack '" + name + "'", GdalScope::last_message(), kKmzAdvice);
    std::string text;
    for (bool is_more = true; is_more;) {
      const std::size_t before = text.size();
      text.resize(before + kPiece_bytes);
      const std::size_t count = VSIFReadL(text.data() + before, 1, kPiece_bytes, file.get());
      text.resize(before + count);
      if (text.size() > left_) {
        throw source_error(path_,
                           "'" + name + "' unpacks to more than the " + std::to_string(most_bytes_) +
                               " bytes that are accepted",
                           "", "give a smaller file");
      }
      is_more = count == kPiece_bytes;
    }
    if (text.empty())
      throw source_error(path_, "cannot unpack '" + name + "'", GdalScope::last_message(), kKmzAdvice);
    left_ -= text.size();
    return text;
  }

  const std::string& path_;
  std::string archive_;
  std::size_t most_bytes_;
  std::size_t left_;
};

}  // namespace

std::vector<std::string> xml_documents(const std::string& path, std::size_t most_bytes) {
  if (has_ending(path, ".kmz")) return KmzReader(path, most_bytes).read();
  std::vector<std::string> texts{whole_text(path, most_bytes)};
  const XmlFindings findings = inspect_xml(texts.front());
  if (!findings.problem.empty()) throw SourceError(path + ": " + findings.problem);
  if (!findings.links.empty()) throw link_error(path, findings.links.front());
  return texts;
}

std::string whole_text(const std::string& path, std::size_t most_bytes) {
  try {
    const std::vector<std::uint8_t> bytes = vpe::base::read_file(path, most_bytes);
    return {bytes.begin(), bytes.end()};
  } catch (const vpe::base::FileError& error) {
    throw SourceError(error.what());
  }
}

}  // namespace mars
