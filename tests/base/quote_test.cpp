#include "vpe/base/quote.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace vpe::base {
namespace {

TEST(Quote, TextStaysAsItIs) {
  EXPECT_EQ(quote_text(""), "\"\"");
  EXPECT_EQ(quote_text("137.3 -4.6"), "\"137.3 -4.6\"");
  EXPECT_EQ(quote_text("4\u00b0 S, \u6f22"), "\"4\u00b0 S, \u6f22\"");
}

TEST(Quote, WhatATerminalMustNotGetIsReplaced) {
  EXPECT_EQ(quote_text("a\nb\x1b[2J\x7f"), "\"a?b?[2J?\"");
  EXPECT_EQ(quote_text("\xff\xc0\x80 \xc2\x9b"), "\"??? ?\"");
  EXPECT_EQ(quote_text("\xe6\xbc"), "\"??\"");
  EXPECT_EQ(quote_text(std::string(50, 'a')), "\"" + std::string(40, 'a') + "...\"");
  EXPECT_EQ(quote_text(std::string(39, 'a') + "\u00b0b"), "\"" + std::string(39, 'a') + "\u00b0...\"");
}

RC_GTEST_PROP(Quote, AnyBytesBecomeOneLine, (const std::string& bytes)) {
  const std::string text = quote_text(bytes);
  RC_ASSERT(text.size() <= 50U);
  for (const char c : text) RC_ASSERT(static_cast<unsigned char>(c) >= 0x20);
}

}  // namespace
}  // namespace vpe::base
