#include "objects/reader/model_folder.h"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "objects/reader/refusal.h"
#include "vpe/base/quote.h"

namespace objects {

namespace fs = std::filesystem;

namespace {

const char* const kMoveAdvice = "move it into the folder of the model and name it relative to that folder";

std::string named(const std::string& kind, const std::string& name) {
  return "it names the " + kind + " " + vpe::base::quote_text(name);
}

// "c:" of a drive counts as well.
bool has_scheme(const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos || colon == 0) return false;
  return std::all_of(name.begin(), name.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.'; });
}

}  // namespace

ModelFolder::ModelFolder(const fs::path& model) {
  std::error_code failure;
  model_ = fs::canonical(model, failure);
  if (failure) throw Refusal(failure.message(), "check the name and the permissions");
  if (!fs::is_regular_file(model_, failure))
    throw Refusal("it is not a regular file", "give the name of a file");
  const std::uintmax_t size = fs::file_size(model_, failure);
  if (failure) throw Refusal(failure.message(), "check the permissions");
  if (size == 0) throw Refusal("it is empty");
  if (size > kMostBytes) throw Refusal("it has more than 2 GB", "simplify the model or split it");
  folder_ = model_.parent_path();
}

bool ModelFolder::holds(const fs::path& canonical) const {
  return std::mismatch(folder_.begin(), folder_.end(), canonical.begin(), canonical.end()).first ==
         folder_.end();
}

fs::path ModelFolder::find(const std::string& name, const std::string& kind) const {
  check_relative(name, kind);
  std::error_code failure;
  const fs::path path = fs::weakly_canonical(folder_ / name, failure);
  if (failure) throw Refusal(named(kind, name) + ", which cannot be found: " + failure.message(), kMoveAdvice);
  if (!holds(path))
    throw Refusal(named(kind, name) + ", which lies outside of the model's folder", kMoveAdvice);
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status))
    throw Refusal(named(kind, name) + ", which does not exist", "put it beside the model");
  if (!fs::is_regular_file(status))
    throw Refusal(named(kind, name) + ", which is not a regular file", "put a file in its place");
  if (fs::file_size(path, failure) > kMostBytes || failure)
    throw Refusal(named(kind, name) + ", which has more than 2 GB", "choose a smaller one");
  return path;
}

void check_relative(const std::string& name, const std::string& kind) {
  if (name.empty()) throw Refusal("it names a " + kind + " without a name");
  if (name.find('\0') != std::string::npos) throw Refusal(named(kind, name) + ", which is no name of a file");
  if (has_scheme(name)) throw Refusal(named(kind, name) + ", which is not a relative path", kMoveAdvice);
  if (name.front() == '/' || name.front() == '\\')
    throw Refusal(named(kind, name) + ", which is an absolute path", kMoveAdvice);
}

}  // namespace objects
