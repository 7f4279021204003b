// vpe get against a web server that fails.
#include <cpl_vsi.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <random>
#include <sstream>

#include "tests/app/support/app_fixture.h"
#include "tests/support/http_server.h"

namespace app_test {
namespace {

#ifdef VPE_HAS_FETCH

using test_support::HttpServer;
using Request = HttpServer::Request;
using Answer = HttpServer::Answer;

constexpr std::size_t kSize = 300'000;
constexpr std::size_t kCut = 100'000;

std::string random_text(unsigned seed, std::size_t size = kSize) {
  std::mt19937 random(seed);
  std::string text(size, ' ');
  for (char& c : text) c = static_cast<char>(random() & 0xff);
  text[0] = 'x';
  return text;
}

class Get : public AppTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(dir_ / "server");
    write_text(dir_ / "server/x.img", content_);
  }

  // Writes the catalogue c.toml of one product "p" with x.img of this server. `more` are keys of the file.
  void write_catalogue(const HttpServer& server, const std::string& more = "") const {
    write_catalogue_text("[[product.file]]\naddress = \"" + server.url("x.img") + "\"\n" + more + "\n");
  }
  void write_catalogue_text(const std::string& files) const {
    write_text(
        dir_ / "c.toml",
        "[[product]]\nname = \"p\"\nbody = \"Mars\"\nkind = \"elevation\"\nwhat = \"w\"\nresolution_m = 10\n"
        "datum = \"areoid\"\nlicence = \"l\"\ncredit = \"c\"\n" +
            files);
  }
  Command get_command(Words more = {}) const {
    Words words{"get", "p", "-o", "out", "--catalogue", "c.toml", "--retry-wait", "0"};
    words.insert(words.end(), more.begin(), more.end());
    Command command = command_for(words);
    command.environment["no_proxy"] = "*";
    return command;
  }
  Result get(const Words& more = {}) const { return run(get_command(more)); }
  void expect_fetched(const Result& result) const {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(read_text(dir_ / "out/x.img") == content_);
    EXPECT_EQ(leftovers(), Words{});
  }
  // Expects exit code 1 with these words, and no file under its final name.
  void expect_refused(const Words& parts, const Words& more = {}) const {
    const Result result = get(more);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(says(result.err, parts));
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(exists("out/x.img"));
  }
  // Returns the checksum that a program such as md5sum prints.
  std::string checksum_by(const std::string& program) const {
    Command command;
    command.program = find_program(program);
    command.arguments = {path("server/x.img")};
    return run(command).out.substr(0, run(command).out.find(' '));
  }
  std::uintmax_t part_size() const {
    std::error_code none;
    const auto size = std::filesystem::file_size(dir_ / "out/x.img.part", none);
    return none ? 0 : size;
  }
  static std::string header(const Request& request, const std::string& name) {
    const auto at = request.headers.find(name);
    return at == request.headers.end() ? "" : at->second;
  }
  static Answer with_etag(const std::string& etag = "\"v1\"") { return {.headers = {{"ETag", etag}}}; }
  static Answer cut(Answer answer) {
    answer.cut_after = kCut;
    return answer;
  }

  std::string content_ = random_text(1);
};

TEST_F(Get, FetchesAllFilesAndPrintsALineThatBuilds) {
  write_dem(dir_ / "server/dem.tif");
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return Answer{}; }));
  write_catalogue_text("[[product.file]]\naddress = \"" + server.url("dem.tif") +
                       "\"\n[[product.file]]\naddress = \"" + server.url("x.img") + "\"\ninput = false\n");
  const Result result = get();
  expect_fetched(result);
  EXPECT_EQ(result.out, "vpe build out/dem.tif --datum areoid --body Mars -o p.vpe\n");
  EXPECT_EQ(read_text(dir_ / "out/dem.tif"), read_text(dir_ / "server/dem.tif"));
  const std::vector<Request> log = server.log();
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[0].path, "dem.tif");
  EXPECT_TRUE(header(log[0], "user-agent").starts_with("vpe/")) << header(log[0], "user-agent");
  Words words{"--base-spacing", "100000"};
  std::istringstream line(result.out.substr(4));
  for (std::string word; line >> word;) words.insert(words.end() - 2, word);
  EXPECT_EQ(vpe(words).exit_code, 0);
  EXPECT_TRUE(exists("p.vpe"));
}

// Rasters in ZIP archives are read as they are.
TEST_F(Get, TheLineOfAnArchiveBuilds) {
  write_dem(dir_ / "dem.tif");
  const std::string dem = read_text(dir_ / "dem.tif");
  VSILFILE* file = VSIFOpenL(("/vsizip/" + path("server/x.zip") + "/in/dem.tif").c_str(), "wb");
  ASSERT_NE(file, nullptr);
  VSIFWriteL(dem.data(), 1, dem.size(), file);
  VSIFCloseL(file);
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return Answer{}; }));
  write_catalogue_text("[[product.file]]\naddress = \"" + server.url("x.zip") +
                       "\"\ninside = [\"in/dem.tif\"]\n");
  const Result result = get();
  EXPECT_EQ(result.out, "vpe build /vsizip/out/x.zip/in/dem.tif --datum areoid --body Mars -o p.vpe\n")
      << result.err;
  EXPECT_EQ(vpe({"build", "/vsizip/out/x.zip/in/dem.tif", "-o", "p.vpe", "--base-spacing", "100000"}).exit_code,
            0);
}

TEST_F(Get, SaysAllInJson) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return Answer{}; }));
  write_catalogue(server, "sha256 = \"" + checksum_by("sha256sum") + "\"");
  const Result result = get({"--json", "--quiet"});
  expect_fetched(result);
  EXPECT_EQ(result.err, "");
  const nlohmann::json json = parse_json(result.out);
  EXPECT_EQ(json["build"], nlohmann::json::array({"vpe build out/x.img --datum areoid --body Mars -o p.vpe"}));
  EXPECT_EQ(json["files"][0]["bytes"], kSize);
  EXPECT_EQ(json["files"][0]["path"], "out/x.img");
  EXPECT_EQ(json["files"][0]["kept"], false);
  EXPECT_EQ(json["files"][0]["checksum"], "SHA-256 " + checksum_by("sha256sum"));
}

TEST_F(Get, ContinuesAfterDroppedConnections) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request& r) {
                            return r.n < 2 ? cut(with_etag()) : with_etag();
                          }));
  write_catalogue(server);
  const Result result = get();
  expect_fetched(result);
  EXPECT_TRUE(says(result.err, {server.url("x.img"), "again in 0 s (1 of 5)"}));
  const std::vector<Request> log = server.log();
  ASSERT_EQ(log.size(), 3U);
  EXPECT_EQ(header(log[0], "range"), "");
  EXPECT_EQ(header(log[1], "range"), "bytes=100000-");
  EXPECT_EQ(header(log[1], "if-range"), "\"v1\"");
  EXPECT_EQ(header(log[2], "range"), "bytes=200000-");
  EXPECT_EQ(server.bytes(), static_cast<std::int64_t>(kSize));
}

// Each part that comes is progress, however many failures there are in all.
TEST_F(Get, ProgressRenewsThePatience) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) {
                            Answer answer = with_etag();
                            answer.cut_after = 60'000;
                            return answer;
                          }));
  write_catalogue(server);
  expect_fetched(get({"--retries", "1"}));
  EXPECT_EQ(server.requests(), 5);
}

TEST_F(Get, ContinuesInAnotherRun) {
  std::atomic<bool> is_cutting{true};
  const HttpServer server(dir_ / "server", HttpServer::Answers([&](const Request&) {
                            return is_cutting ? cut(Answer{}) : Answer{};  // known by Last-Modified
                          }));
  write_catalogue(server);
  expect_refused({server.url("x.img"), "1 times", "the same command continues"}, {"--retries", "0"});
  EXPECT_EQ(part_size(), kCut);
  is_cutting = false;
  expect_fetched(get());
  EXPECT_EQ(header(server.log().back(), "if-range"), "Sat, 21 Nov 2026 08:00:00 GMT");
  EXPECT_EQ(server.bytes(), static_cast<std::int64_t>(kSize));
}

TEST_F(Get, NeverJoinsTwoVersions) {
  const std::string old = content_;
  content_ = random_text(2);
  // How a server tells of the second version: it obeys If-Range, it ignores it, it states nothing.
  for (const std::string kind : {"obeys", "ignores", "states nothing", "knows no ranges"}) {
    SCOPED_TRACE(kind);
    std::filesystem::remove_all(dir_ / "out");
    write_text(dir_ / "server/x.img", old);
    const HttpServer server(dir_ / "server", HttpServer::Answers([&](const Request& r) {
                              if (r.n == 1) write_text(dir_ / "server/x.img", content_);
                              Answer answer = with_etag(r.n == 0 ? "\"v1\"" : "\"v2\"");
                              answer.headers["Last-Modified"] = "";
                              answer.obeys_if_range = kind != "ignores";
                              answer.knows_ranges = kind != "knows no ranges";
                              if (kind == "states nothing") answer.headers["ETag"] = "";
                              return r.n == 0 ? cut(answer) : answer;
                            }));
    write_catalogue(server);
    expect_fetched(get());
    // The request that brought the whole second version.
    EXPECT_EQ(header(server.log().back(), "range") == "", kind == "states nothing" || kind == "ignores");
  }
}

// The last byte is asked for again, so that the server says which version it has now.
TEST_F(Get, ACompletePartIsConfirmed) {
  for (const bool is_changed : {false, true}) {
    std::filesystem::remove_all(dir_ / "out");
    std::filesystem::create_directory(dir_ / "out");
    const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return with_etag(); }));
    write_catalogue(server);
    write_text(dir_ / "out/x.img.part", is_changed ? random_text(3) : content_);
    write_text(dir_ / "out/x.img.part.json", "{\"address\": \"" + server.url("x.img") + "\", \"etag\": \"\\\"" +
                                                 (is_changed ? "v0" : "v1") +
                                                 "\\\"\", \"last_modified\": \"\", \"total_bytes\": 300000, "
                                                 "\"refused\": false}");
    expect_fetched(get());
    EXPECT_EQ(server.bytes(), is_changed ? static_cast<std::int64_t>(kSize) : 1);
  }
}

TEST_F(Get, DamagedStatesBeginAnew) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return with_etag(); }));
  write_catalogue(server);
  std::filesystem::create_directory(dir_ / "out");
  for (const char* state : {"", "{\"address\":", "[1]"}) {
    write_text(dir_ / "out/x.img.part", "rubbish");
    write_text(dir_ / "out/x.img.part.json", state);
    expect_fetched(get());
    std::filesystem::remove(dir_ / "out/x.img");
  }
}

TEST_F(Get, FollowsRedirectsToTheWebOnly) {
  const auto redirect = [](const std::string& address) {
    return Answer{.status = 302, .headers = {{"Location", address}}};
  };
  const HttpServer server(dir_ / "server", HttpServer::Answers([&](const Request& r) {
                            if (r.path == "loop") return redirect("/loop");
                            if (r.path == "file") return redirect("file:///etc/passwd");
                            if (r.path == "ftp") return redirect("ftp://127.0.0.1/x");
                            if (r.path == "there") return redirect("/x.img");
                            return Answer{};
                          }));
  const auto point_to = [&](const std::string& path) {
    write_catalogue_text("[[product.file]]\nname = \"x.img\"\naddress = \"" + server.url(path) + "\"\n");
  };
  point_to("there");
  expect_fetched(get());
  std::filesystem::remove_all(dir_ / "out");
  for (const char* path : {"loop", "file", "ftp"}) {
    point_to(path);
    const int before = server.requests();
    expect_refused({server.url(path), path == std::string("loop") ? "redirects" : "Protocol"});
    EXPECT_EQ(server.requests() - before, path == std::string("loop") ? 11 : 1) << path;
    EXPECT_EQ(leftovers(), Words{});
  }
}

TEST_F(Get, ErrorsThatStayAreToldAtOnce) {
  for (const auto& [status, words] : {std::pair{404, "HTTP 404 (not found)"}, std::pair{403, "HTTP 403"}}) {
    const HttpServer server(dir_ / "server", HttpServer::Answers([status = status](const Request&) {
                              return Answer{.status = status};
                            }));
    write_catalogue(server);
    expect_refused({server.url("x.img"), words, "check the address"});
    EXPECT_EQ(server.requests(), 1);
    EXPECT_EQ(leftovers(), Words{});
  }
}

TEST_F(Get, ErrorsThatPassAreWaitedFor) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request& r) {
                            if (r.n == 0) return Answer{.status = 503};
                            if (r.n == 1) return Answer{.status = 429, .headers = {{"Retry-After", "1"}}};
                            return Answer{};
                          }));
  write_catalogue(server);
  const Result result = get();
  expect_fetched(result);
  EXPECT_TRUE(says(result.err, {"HTTP 503 (unavailable); again in 0 s (1 of 5)",
                                "HTTP 429 (too many requests); again in 1 s (2 of 5)"}));
}

TEST_F(Get, PatienceEnds) {
  const HttpServer server(dir_ / "server",
                          HttpServer::Answers([](const Request&) { return Answer{.status = 503}; }));
  write_catalogue(server);
  expect_refused({"HTTP 503", "3 times", "try again later"}, {"--retries", "2"});
  EXPECT_EQ(server.requests(), 3);
  const HttpServer busy(dir_ / "server", HttpServer::Answers([](const Request&) {
                          return Answer{.status = 429, .headers = {{"Retry-After", "4000"}}};
                        }));
  write_catalogue(busy);
  expect_refused({"HTTP 429", "asks to wait 4000 s", "try again later"});
  EXPECT_EQ(busy.requests(), 1);
}

// A server that always begins anew makes no progress.
TEST_F(Get, PatienceEndsWithoutProgress) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) {
                            Answer answer;
                            answer.knows_ranges = false;
                            return cut(answer);
                          }));
  write_catalogue(server);
  expect_refused({"3 times"}, {"--retries", "2"});
  EXPECT_EQ(server.requests(), 3);
}

TEST_F(Get, NoServerIsTold) {
  std::string address;
  {
    const HttpServer server(dir_ / "server");
    write_catalogue(server);
    address = server.url("x.img");
  }
  expect_refused({address, "2 times"}, {"--retries", "1"});
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(Get, AServerThatHangsIsGivenUp) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) {
                            Answer answer = cut(with_etag());
                            answer.hangs = true;
                            return answer;
                          }));
  write_catalogue(server);
  expect_refused({server.url("x.img"), "too slow", "the same command continues"},
                 {"--stall-timeout", "1", "--retries", "0"});
  EXPECT_EQ(part_size(), kCut);
}

TEST_F(Get, PagesForPeopleAreRefused) {
  for (const bool is_honest : {true, false}) {
    const HttpServer server(dir_ / "server", HttpServer::Answers([&](const Request&) {
                              Answer answer{.body = "<!DOCTYPE html><p>We have moved</p>"};
                              if (is_honest) answer.headers["Content-Type"] = "text/html; charset=utf-8";
                              return answer;
                            }));
    write_catalogue(server);
    expect_refused({server.url("x.img"), is_honest ? "text/html" : "HTML page", "in place of the file"});
    EXPECT_EQ(leftovers(), Words{});
  }
}

TEST_F(Get, WrongSizesAreRefused) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return Answer{}; }));
  write_catalogue(server, "bytes = 299999");
  expect_refused({server.url("x.img"), "300000 bytes", "catalogue says 299999"});
  EXPECT_EQ(leftovers(), Words{});
  // The server does not say how long the file is, and the end comes early.
  const HttpServer silent(dir_ / "server", HttpServer::Answers([](const Request&) {
                            return cut(Answer{.headers = {{"Content-Length", ""}}});
                          }));
  write_catalogue(silent, "bytes = 300000");
  expect_refused({"sent 100000 bytes", "catalogue says 300000", "x.img.part"});
  EXPECT_EQ(part_size(), kCut);
  // It says that the file is longer than it is.
  std::filesystem::remove_all(dir_ / "out");
  const HttpServer lying(dir_ / "server", HttpServer::Answers([](const Request& r) {
                           Answer answer = with_etag();
                           if (r.n == 0) answer.headers["Content-Length"] = "400000";
                           return answer;
                         }));
  write_catalogue(lying);
  expect_refused({lying.url("x.img")}, {"--retries", "0"});
  EXPECT_EQ(part_size(), kSize);
  expect_fetched(get());
}

TEST_F(Get, ChecksumsAreVerified) {
  const std::string md5 = checksum_by("md5sum");
  write_text(dir_ / "server/x.img.md5", md5 + "  x.img\n");
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return Answer{}; }));
  for (const std::string& key : {"md5 = \"" + md5 + "\"", "sha256 = \"" + checksum_by("sha256sum") + "\"",
                                 "md5_address = \"" + server.url("x.img.md5") + "\""}) {
    write_catalogue(server, key);
    const Result result = get({"--force"});
    expect_fetched(result);
    EXPECT_TRUE(says(result.err, {"checksum is right"})) << key;
  }
}

TEST_F(Get, WrongChecksumsLeaveThePart) {
  write_text(dir_ / "server/x.img.md5", std::string(32, '0') + "  x.img\n");
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return with_etag(); }));
  for (const std::string& key :
       {"md5 = \"" + std::string(32, '1') + "\"", "sha256 = \"" + std::string(64, '2') + "\"",
        "md5_address = \"" + server.url("x.img.md5") + "\""}) {
    write_catalogue(server, key);
    expect_refused({server.url("x.img"), "does not have the", "checksum", "x.img.part"});
    EXPECT_EQ(part_size(), kSize) << key;
  }
  // What was refused is not continued.
  write_catalogue(server, "md5 = \"" + checksum_by("md5sum") + "\"");
  const std::int64_t before = server.bytes();
  expect_fetched(get());
  EXPECT_EQ(server.bytes() - before, static_cast<std::int64_t>(kSize));
  std::filesystem::remove_all(dir_ / "out");
  write_catalogue(server, "md5 = \"" + std::string(32, '1') + "\"");
  expect_fetched(get({"--no-checksum"}));
}

TEST_F(Get, ChecksumFilesMustDescribeTheFile) {
  write_text(dir_ / "server/other.md5", std::string(32, '0') + "  other.img\n");
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return Answer{}; }));
  write_catalogue(server, "md5_address = \"" + server.url("other.md5") + "\"");
  expect_refused({server.url("other.md5"), "no MD5 checksum of 'x.img'", "--no-checksum"});
  write_catalogue(server, "md5_address = \"" + server.url("absent.md5") + "\"");
  expect_refused({server.url("absent.md5"), "HTTP 404", "--no-checksum"});
  EXPECT_EQ(leftovers(), Words{});
}

TEST_F(Get, FinishedFilesAreKept) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return Answer{}; }));
  write_catalogue(server, "bytes = 300000\nsha256 = \"" + checksum_by("sha256sum") + "\"");
  expect_fetched(get());
  const Result again = get();
  expect_fetched(again);
  EXPECT_TRUE(says(again.err, {"out/x.img", "kept", "--force"}));
  EXPECT_EQ(again.out, "vpe build out/x.img --datum areoid --body Mars -o p.vpe\n");
  EXPECT_EQ(server.requests(), 1);
  expect_fetched(get({"--check"}));
  // Another content of the same size is found by its checksum alone, another size at once.
  write_text(dir_ / "out/x.img", random_text(4));
  EXPECT_EQ(get().exit_code, 0);
  const Result checked = get({"--check"});
  EXPECT_EQ(checked.exit_code, 1);
  EXPECT_TRUE(says(checked.err, {"out/x.img", "checksum", "--force"}));
  write_text(dir_ / "out/x.img", "short");
  const Result sized = get();
  EXPECT_EQ(sized.exit_code, 1);
  EXPECT_TRUE(says(sized.err, {"out/x.img", "5 bytes", "catalogue says 300000", "--force"}));
  EXPECT_EQ(server.requests(), 1);
  expect_fetched(get({"--force"}));
}

TEST_F(Get, SignalsKeepThePart) {
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    std::filesystem::remove_all(dir_ / "out");
    const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request& r) {
                              Answer answer = with_etag();
                              if (r.n == 0) answer.cut_after = kCut;
                              answer.hangs = r.n == 0;
                              return answer;
                            }));
    write_catalogue(server);
    Command command = get_command();
    command.signal = signal;
    command.when = [&] { return part_size() == kCut; };
    const Result result = run(command);
    EXPECT_TRUE(result.signalled);
    EXPECT_EQ(result.exit_code, code) << result.signal << result.err;
    EXPECT_TRUE(says(result.err, {"stopped", "out/x.img", "the same command continues"}));
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(part_size(), kCut);
    expect_fetched(get());
    EXPECT_EQ(header(server.log().at(1), "range"), "bytes=100000-");
  }
}

TEST_F(Get, SignalsEndThePauseBetweenRequests) {
  std::atomic<bool> is_asked{false};
  const HttpServer server(dir_ / "server", HttpServer::Answers([&](const Request&) {
                            is_asked = true;
                            return Answer{.status = 503};
                          }));
  write_catalogue(server);
  Command command = get_command({"--retry-wait", "3600"});
  command.arguments.erase(command.arguments.begin() + 6, command.arguments.begin() + 8);  // the fixture's own
  command.signal = SIGTERM;
  command.when = [&] { return is_asked.load(); };
  EXPECT_EQ(run(command).exit_code, 143);
}

TEST_F(Get, TwoProcessesDoNotShareAFile) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return Answer{}; }));
  write_catalogue(server);
  std::filesystem::create_directory(dir_ / "out");
  const int part = ::open(path("out/x.img.part").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  ASSERT_EQ(::flock(part, LOCK_EX), 0);
  expect_refused({"another process fetches", "out/x.img"});
  EXPECT_EQ(server.requests(), 0);
  ::close(part);
  expect_fetched(get());
}

TEST_F(Get, SmallDisksAreToldBefore) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) {
                            return cut(Answer{.headers = {{"Content-Length", "4000000000000000000"}}});
                          }));
  write_catalogue(server, "about_bytes = 4000000000000000000");
  expect_refused({"out", "4000000000 GB are to be fetched", "are free"});
  EXPECT_EQ(server.requests(), 0);
  write_catalogue(server);
  expect_refused({"out/x.img", "4000000000 GB", "free on the disk"});
  EXPECT_EQ(server.requests(), 1);
}

TEST_F(Get, FoldersThatCannotBeMadeAreTold) {
  const HttpServer server(dir_ / "server", HttpServer::Answers([](const Request&) { return Answer{}; }));
  write_catalogue(server);
  write_text(dir_ / "out", "in the way");
  const Result result = get();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, {"out"}));
  std::filesystem::remove(dir_ / "out");
  std::filesystem::create_directories(dir_ / "out/x.img");
  const Result folder = get();
  EXPECT_EQ(folder.exit_code, 1);
  EXPECT_TRUE(says(folder.err, {"out/x.img", "is no file"}));
  EXPECT_EQ(server.requests(), 0);
}

#endif

// The catalogue can be read without libcurl too.
class GetListing : public AppTest {};

TEST_F(GetListing, ListsAndDescribes) {
  const Result list = vpe({"get"});
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_TRUE(says(list.out, {"mola128", "2.08 GB", "hirise ID", "public domain", "gebco2024"}));
  const nlohmann::json json = parse_json(vpe({"get", "--json"}).out);
  EXPECT_GE(json.size(), 15U);
  EXPECT_EQ(json[0]["name"], "mola4");
  const Result about = vpe({"get", "mola128", "hirise", "DTEEC_041277_2115_040776_2115_A01", "--about"});
  EXPECT_EQ(about.exit_code, 0);
  EXPECT_TRUE(says(about.out, {"areoid", "44s270", "https://pds-geosciences.wustl.edu/", "such as DTEEC_"}));
  EXPECT_EQ(parse_json(vpe({"get", "mola128", "--about", "--json"}).out)[0]["tiles"].size(), 16U);
}

TEST_F(GetListing, WrongUsageIsExplained) {
  expect_failure({"get", "mola129", "-o", "out"}, 2, {"mola129", "did you mean mola128"});
  expect_failure({"get", "mola129", "--about"}, 2, {"mola129", "did you mean mola128"});
  expect_failure({"get", "mola128"}, 2, {"-o DIR", "--about"});
  expect_failure({"get", "-o", "out"}, 2, {"name a product"});
  expect_failure({"get", "hirise", "-o", "out"}, 2, {"needs ID", "DTEEC_041277_2115_040776_2115_A01"});
  expect_failure({"get", "mola128", "--tile", "x", "-o", "out"}, 2, {"--tile x", "44s270"});
  expect_failure({"get", "mola128", "--retries", "-1", "-o", "out"}, 2, {"--retries"});
  expect_failure({"get", "--catalogue", "absent.toml"}, 1, {"absent.toml"});
  write_text(dir_ / "bad.toml", "[[product]]\nname = 5\n");
  expect_failure({"get", "--catalogue", "bad.toml"}, 1, {"bad.toml:2", "'name'"});
  EXPECT_FALSE(exists("out"));
}

}  // namespace
}  // namespace app_test
