// Small images and programs that judge them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tests/app/support/process.h"
#include "tests/support/support.h"
#include "vpe/core/image/image.h"

namespace panorama_test {

inline std::vector<vpe::base::Rgb> pixels(int width, int height) {
  std::vector<vpe::base::Rgb> all(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = {static_cast<std::uint8_t>(n * 7), 40, 200};
  return all;
}

inline std::vector<std::uint8_t> png(int width, int height) {
  return vpe::core::encode_png(pixels(width, height), width, height);
}

inline std::vector<std::uint8_t> jpeg(int width, int height) {
  return vpe::core::encode_jpeg(pixels(width, height), width, height, 90);
}

// What a program prints; a test failure when it is not there (.ci/packages.txt has it) or fails.
inline std::string output_of(const std::string& program, std::vector<std::string> arguments) {
  const std::filesystem::path path = app_test::find_program(program);
  if (path.empty()) {
    ADD_FAILURE() << program << " is not installed; .ci/packages.txt names its package";
    return {};
  }
  const test_support::TempDir folder;
  app_test::Command command;
  command.program = path;
  command.arguments = std::move(arguments);
  command.folder = folder.path();
  const app_test::Result result = app_test::run(command);
  EXPECT_EQ(result.exit_code, 0) << program << ": " << result.err << result.out;
  EXPECT_EQ(result.err, "");
  return result.out;
}

// The message of what an action throws, empty when it throws nothing.
template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const std::exception& e) {
    return e.what();
  }
  return {};
}

// The message has all of these words in it.
inline void expect_says(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << "no '" << word << "' in: " << message;
  }
}

}  // namespace panorama_test

#define EXPECT_SAYS(message, ...)                       \
  {                                                     \
    SCOPED_TRACE("EXPECT_SAYS");                        \
    panorama_test::expect_says(message, {__VA_ARGS__}); \
  }
