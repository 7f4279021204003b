#include "vpe/base/user_folders.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace vpe::base {
namespace {

base::Environment environment(const std::map<std::string, std::string>& variables) {
  return [variables](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  };
}

TEST(UserFolders, VariablesGoBeforeHome) {
  const Environment set = environment({{"HOME", "/h"},
                                       {"XDG_CACHE_HOME", "/c"},
                                       {"XDG_CONFIG_HOME", "/f"},
                                       {"XDG_DATA_HOME", "/d"},
                                       {"XDG_STATE_HOME", "/s"}});
  EXPECT_EQ(user_folder(UserFolder::kCache, set), "/c/vpe");
  EXPECT_EQ(user_folder(UserFolder::kConfig, set), "/f/vpe");
  EXPECT_EQ(user_folder(UserFolder::kData, set), "/d/vpe");
  EXPECT_EQ(user_folder(UserFolder::kState, set), "/s/vpe");
  const Environment home = environment({{"HOME", "/h"}, {"XDG_CACHE_HOME", ""}, {"XDG_DATA_HOME", "relative"}});
  EXPECT_EQ(user_folder(UserFolder::kCache, home), "/h/.cache/vpe");
  EXPECT_EQ(user_folder(UserFolder::kConfig, home), "/h/.config/vpe");
  EXPECT_EQ(user_folder(UserFolder::kData, home), "/h/.local/share/vpe");
  EXPECT_EQ(user_folder(UserFolder::kState, home), "/h/.local/state/vpe");
  EXPECT_EQ(user_folder(UserFolder::kData, environment({{"HOME", "relative"}})), "");
}

TEST(UserFolders, SettingsAreLookedForInTheSystemsFoldersToo) {
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_EQ(config_folders(environment({})), (Paths{"/etc/xdg/vpe"}));
  EXPECT_EQ(config_folders(environment({{"HOME", "/h"}, {"XDG_CONFIG_DIRS", "/a:relative::/b"}})),
            (Paths{"/h/.config/vpe", "/a/vpe", "/b/vpe"}));
}

}  // namespace
}  // namespace vpe::base
