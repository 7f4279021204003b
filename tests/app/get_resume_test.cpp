// Decisions about unfinished downloads, without a network.
#include "vpe/app/get/resume.h"

#include <gtest/gtest.h>

#include "vpe/app/get/checksum.h"

namespace vpe::app {
namespace {

using Action = AnswerDecision::Action;

constexpr const char* kAddress = "https://a/x.img";
constexpr const char* kTime = "Sat, 21 Nov 2026 08:00:00 GMT";

PartState state(const std::string& etag = "\"v1\"") { return {kAddress, etag, kTime, 1000, false}; }

ResponseHead head_of(const std::vector<std::string>& lines) {
  ResponseHead head;
  for (const std::string& line : lines) read_head_line(line + "\r\n", head);
  return head;
}

TEST(GetResume, StatesAreReadBack) {
  const PartState written{"https://a/\"x\"", "W/\"e\"", kTime, 11'384'463'908, true};
  EXPECT_EQ(parse_part_state(part_state_text(written)), written);
  for (const char* text : {"", "{", "[]", "{}", R"({"address": 1, "etag": "", "last_modified": ""})"})
    EXPECT_FALSE(parse_part_state(text)) << text;
}

// They become lines of a request.
TEST(GetResume, StatesWithControlCharactersAreNotUsed) {
  PartState bad = state("\"a\r\nHost: b\"");
  EXPECT_FALSE(parse_part_state(part_state_text(bad)));
  bad = state();
  bad.total_bytes = -1;
  EXPECT_FALSE(parse_part_state(part_state_text(bad)));
}

TEST(GetResume, ContinuesWhereTheVersionIsKnown) {
  const ResumePlan plan = plan_resume(state(), 400, kAddress);
  EXPECT_EQ(plan.offset, 400);
  EXPECT_EQ(plan.validator, "\"v1\"");
  // A weak tag does not tell equal bytes.
  EXPECT_EQ(plan_resume(state("W/\"v1\""), 400, kAddress).validator, kTime);
  EXPECT_EQ(plan_resume(state(""), 400, kAddress).validator, kTime);
  // All is here, but the server must say so.
  EXPECT_EQ(plan_resume(state(), 1000, kAddress).offset, 999);
}

TEST(GetResume, BeginsAnewWhereItIsNot) {
  EXPECT_EQ(plan_resume(std::nullopt, 400, kAddress).offset, 0);
  EXPECT_EQ(plan_resume(state(), 0, kAddress).offset, 0);
  EXPECT_EQ(plan_resume(state(), 1001, kAddress).offset, 0);
  EXPECT_EQ(plan_resume(state(), 400, "https://b/x.img").offset, 0);
  PartState other = state("");
  other.last_modified = "";
  EXPECT_EQ(plan_resume(other, 400, kAddress).offset, 0);
  other = state();
  other.is_refused = true;
  EXPECT_EQ(plan_resume(other, 400, kAddress).offset, 0);
  other = state();
  other.total_bytes = 1;
  const ResumePlan plan = plan_resume(other, 1, kAddress);
  EXPECT_EQ(plan.offset, 0);
  EXPECT_EQ(plan.validator, "");
}

TEST(GetResume, HeadsAreRead) {
  const ResponseHead head =
      head_of({"HTTP/1.1 302 Found", "ETag: \"of the redirect\"", "Location: b", "", "HTTP/2 206",
               "etag: \"v1\"", "LAST-MODIFIED:  " + std::string(kTime), "Content-Length: 600",
               "content-range: bytes 400-999/1000", "Content-Type: image/tiff"});
  EXPECT_EQ(head.status, 206);
  EXPECT_EQ(head.etag, "\"v1\"");
  EXPECT_EQ(head.last_modified, kTime);
  EXPECT_EQ(head.content_length, 600);
  EXPECT_EQ(head.range_first, 400);
  EXPECT_EQ(head.range_total, 1000);
  EXPECT_EQ(head.content_type, "image/tiff");
  EXPECT_EQ(head_of({"HTTP/1.1 206", "Content-Range: bytes 400-999/*"}).range_total, -1);
  EXPECT_EQ(head_of({"HTTP/1.1 206", "Content-Range: nonsense"}).range_first, -1);
}

ResponseHead partial(const std::string& range = "bytes 400-999/1000", const std::string& etag = "\"v1\"") {
  return head_of({"HTTP/1.1 206 Partial", "Content-Range: " + range, "ETag: " + etag});
}

TEST(GetResume, AnswersThatContinueAreTaken) {
  const ResumePlan plan = plan_resume(state(), 400, kAddress);
  const AnswerDecision decision = decide(partial(), plan, state(), {"x.img", 1000});
  EXPECT_EQ(decision.action, Action::kTake);
  EXPECT_EQ(decision.offset, 400);
  EXPECT_EQ(decision.total_bytes, 1000);
  // The server's copy changed, or it knows no ranges: the whole file.
  const AnswerDecision whole =
      decide(head_of({"HTTP/1.1 200 OK", "Content-Length: 1000"}), plan, state(), {"x.img", 1000});
  EXPECT_EQ(whole.action, Action::kTake);
  EXPECT_EQ(whole.offset, 0);
}

TEST(GetResume, AnswersThatDoNotContinueBeginAnew) {
  const ResumePlan plan = plan_resume(state(), 400, kAddress);
  const auto action = [&](const ResponseHead& head) {
    return decide(head, plan, state(), {"x.img", 0}).action;
  };
  EXPECT_EQ(action(partial("bytes 300-999/1000")), Action::kBeginAnew);
  EXPECT_EQ(action(partial("bytes 400-1099/1100")), Action::kBeginAnew);
  EXPECT_EQ(action(partial("bytes 400-999/1000", "\"v2\"")), Action::kBeginAnew);
  EXPECT_EQ(action(partial("what")), Action::kBeginAnew);
  EXPECT_EQ(action(head_of({"HTTP/1.1 416 no", "Content-Range: bytes */300"})), Action::kBeginAnew);
  // Without a range in the request it is an error of the server, and asking again would not end.
  EXPECT_EQ(decide(partial(), {}, std::nullopt, {"x.img", 0}).action, Action::kGiveUp);
  EXPECT_EQ(decide(head_of({"HTTP/1.1 416 no"}), {}, std::nullopt, {"x.img", 0}).action, Action::kGiveUp);
}

TEST(GetResume, ErrorsPassOrDoNot) {
  const auto action = [](int status) {
    return decide(head_of({"HTTP/1.1 " + std::to_string(status) + " x"}), {}, std::nullopt, {"x.img", 0})
        .action;
  };
  for (const int status : {408, 429, 500, 502, 503, 504})
    EXPECT_EQ(action(status), Action::kTryAgain) << status;
  for (const int status : {204, 304, 400, 401, 403, 404, 410, 451, 501})
    EXPECT_EQ(action(status), Action::kGiveUp) << status;
}

TEST(GetResume, WhatIsNotTheFileIsRefused) {
  const auto problem = [](const std::vector<std::string>& lines, const Expected& expected) {
    const AnswerDecision decision = decide(head_of(lines), {}, std::nullopt, expected);
    EXPECT_EQ(decision.action == Action::kTake, decision.problem.empty());
    return decision.problem;
  };
  const std::string ok = "HTTP/1.1 200 OK";
  EXPECT_EQ(problem({ok, "Content-Type: application/octet-stream", "Content-Length: 9"}, {"x.img", 9}), "");
  EXPECT_EQ(problem({ok}, {"x.img", 9}), "");  // the length is not stated: it is compared at the end
  EXPECT_NE(problem({ok, "Content-Length: 8"}, {"x.img", 9}).find("8 bytes, but the catalogue says 9"),
            std::string::npos);
  EXPECT_NE(problem({ok, "Content-Type: text/html; charset=utf-8"}, {"x.img", 0}).find("text/html"),
            std::string::npos);
  EXPECT_EQ(problem({ok, "Content-Type: text/html"}, {"x.html", 0}), "");
  EXPECT_NE(problem({ok, "Content-Length: 0"}, {"x.img", 0}), "");
}

TEST(GetResume, PagesForPeopleAreKnownByTheirBeginning) {
  EXPECT_TRUE(begins_as_html("<!DOCTYPE html>\n<html>"));
  EXPECT_TRUE(begins_as_html("\xef\xbb\xbf\r\n  <HTML lang=en>"));
  EXPECT_FALSE(begins_as_html("PDS_VERSION_ID = PDS3"));
  EXPECT_FALSE(begins_as_html("<?xml version=\"1.0\"?><Product_Observational>"));
  EXPECT_FALSE(begins_as_html(""));
}

TEST(GetChecksum, Md5FilesAreRead) {
  const std::string md5 = "a0e0bbf33ecb0ff65ece9cfa8e08813e";
  EXPECT_EQ(parse_md5_file(md5 + "  x.tif\n", "x.tif"), md5);
  EXPECT_EQ(parse_md5_file("A0E0BBF33ECB0FF65ECE9CFA8E08813E *data/x.tif\r\n", "x.tif"), md5);
  EXPECT_EQ(parse_md5_file(md5, "x.tif"), md5);
  EXPECT_EQ(parse_md5_file("ffffffffffffffffffffffffffffffff  y.tif\n" + md5 + "  x.tif\n", "x.tif"), md5);
  EXPECT_FALSE(parse_md5_file(md5 + "  y.tif\n", "x.tif"));
  EXPECT_FALSE(parse_md5_file(md5.substr(1) + "  x.tif\n", "x.tif"));
  EXPECT_FALSE(parse_md5_file("<html>404</html>", "x.tif"));
}

}  // namespace
}  // namespace vpe::app
