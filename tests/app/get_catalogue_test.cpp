// The catalogue of public data: what it may hold, addresses, choices, and the lines for vpe build.
#include "vpe/app/get/catalogue.h"

#include <gtest/gtest.h>

#include <set>

#include "vpe/app/cli/program.h"
#include "vpe/app/cli/shell_word.h"
#include "vpe/app/get/build_line.h"
#include "vpe/app/get/listing.h"
#include "vpe/app/get/selection.h"

namespace vpe::app {
namespace {

// A product "p" with more keys, and a file with more keys.
std::string text_with(const std::string& product, const std::string& file, const std::string& address,
                      const std::string& kind = "kind = \"elevation\"\ndatum = \"areoid\"") {
  return "[[product]]\nname = \"p\"\nbody = \"Mars\"\n" + kind +
         "\nwhat = \"w\"\nresolution_m = 10\nlicence = \"l\"\ncredit = \"c\"\n" + product +
         "\n[[product.file]]\naddress = \"" + address + "\"\n" + file + "\n";
}

const std::string kPlain = "https://a.org/x.img";

std::string problem_of(const std::string& text) {
  try {
    parse_catalogue(text, "c.toml");
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

TEST(GetCatalogue, TheProgramsOwnIsUsable) {
  const Catalogue catalogue = embedded_catalogue();
  std::set<std::string> bodies;
  for (const Product& p : catalogue) {
    bodies.insert(p.body);
    for (const RemoteFile& file : product_files(p, {p.parameter ? p.parameter->example : "", {}})) {
      EXPECT_TRUE(file.address.starts_with("https://")) << file.address;
      EXPECT_GT(file.about_bytes, 0) << file.address;
    }
    EXPECT_GT(total_bytes(p), 0) << p.name;
  }
  EXPECT_EQ(bodies, (std::set<std::string>{"Mars", "Moon", "Mercury", "Vesta", "Ceres", "Earth"}));
  for (const char* name : {"mola128", "hrsc-mola", "mdim21", "ctx", "hirise", "lola64", "gebco2024"})
    EXPECT_NE(find_product(catalogue, name), nullptr) << name;
}

// Addresses that other projects have fetched from.
TEST(GetCatalogue, HiriseAddressesFollowFromTheId) {
  const Catalogue catalogue = embedded_catalogue();
  const Product& hirise = *find_product(catalogue, "hirise");
  const auto address = [&](const std::string& id) { return product_files(hirise, {id, {}}).at(0).address; };
  EXPECT_EQ(address("DTEEC_046764_1660_050812_1660_A01"),
            "https://www.uahirise.org/PDS/DTM/ESP/ORB_046700_046799/ESP_046764_1660_ESP_050812_1660/"
            "DTEEC_046764_1660_050812_1660_A01.IMG");
  EXPECT_EQ(address("DTEEC_010573_1985_010639_1985_U01"),
            "https://www.uahirise.org/PDS/DTM/PSP/ORB_010500_010599/PSP_010573_1985_PSP_010639_1985/"
            "DTEEC_010573_1985_010639_1985_U01.IMG");
  EXPECT_EQ(address("DTEED_042328_1985_033150_1985_A01"),
            "https://www.uahirise.org/PDS/DTM/ESP/ORB_042300_042399/ESP_042328_1985_ESP_033150_1985/"
            "DTEED_042328_1985_033150_1985_A01.IMG");
  EXPECT_EQ(hirise_phase(10639), "PSP");
  EXPECT_EQ(hirise_phase(11261), "ESP");
  EXPECT_THROW(hirise_phase(823), std::runtime_error);
  for (const char* id : {"DTRRC_046764_1660_050812_1660_A01", "DTEEC_46764_1660_050812_1660_A01",
                         "DTEEC_046764_1660_050812_1660_A01/../x", "dteec_046764_1660_050812_1660_a01", ""})
    EXPECT_FALSE(matches_parameter(*hirise.parameter, id)) << id;
}

TEST(GetCatalogue, TilesAndCtxHaveTheirAddresses) {
  const Catalogue catalogue = embedded_catalogue();
  const std::vector<RemoteFile> all = product_files(*find_product(catalogue, "mola128"), {});
  ASSERT_EQ(all.size(), 32U);
  EXPECT_TRUE(all[0].address.ends_with("/meg128/megt88n000hb.lbl"));  // the label first
  EXPECT_TRUE(all[1].address.ends_with("/meg128/megt88n000hb.img"));
  EXPECT_TRUE(all[31].address.ends_with("/meg128/megt44s270hb.img"));
  const std::vector<RemoteFile> tile = product_files(*find_product(catalogue, "ctx"), {"E-036_N-28", {}});
  EXPECT_EQ(tile.at(0).address,
            "https://murray-lab.caltech.edu/CTX/V01/tiles/MurrayLab_GlobalCTXMosaic_V01_E-036_N-28.zip");
}

TEST(GetCatalogue, MistakesAreToldWithFileAndLine) {
  EXPECT_EQ(problem_of(text_with("", "", kPlain)), "");
  const std::vector<std::pair<std::string, std::string>> bad{
      {"[[product]\n", "c.toml:1: not TOML"},
      {"a.a.a.a.a.a.a.a.a.a.a.a = 1\n", "c.toml:1: expected keys with fewer dots"},
      {"", "has no [[product]]"},
      {"colour = 1\n" + text_with("", "", kPlain), "c.toml:1: unknown key 'colour' in the catalogue"},
      {text_with("datun = \"x\"", "", kPlain), "c.toml:10: unknown key 'datun' in [[product]]"},
      {text_with("", "size = 1", kPlain), "c.toml:13: unknown key 'size' in [[product.file]]"},
      {text_with("", "bytes = -1", kPlain), "c.toml:13: 'bytes': expected a number of bytes"},
      {text_with("", "bytes = \"5 GB\"", kPlain), "c.toml:13: 'bytes'"},
      {text_with("", "md5 = \"12\"", kPlain), "c.toml:13: 'md5': expected 32 hexadecimal digits"},
      {text_with("", "input = false", kPlain), "'p' has no input"},
      {text_with("", "name = \"../x\"", kPlain), "does not end in the name of a file"},
      {text_with("", "", "https://a.org/folder/"), "c.toml:11: 'https://a.org/folder/' does not end"},
      {text_with("", "", "file:///etc/passwd"), "is not an http(s) address"},
      {text_with("", "", "https://a.org/{tile}.img"), "{tile} stands for nothing here"},
      {text_with("", "", "https://a.org/{1}.img"), "{1} stands for nothing here"},
      {text_with("", "", "https://a.org/{tile.img"), "a brace is not closed"},
      {text_with("tiles = 5", "", kPlain), "c.toml:10: 'tiles': expected a list of texts"},
      {text_with("[product.parameter]\nname = \"ID\"\npattern = \"(\"\nexample = \"a\"", "", kPlain),
       "c.toml:12: 'pattern' is not a regular expression"},
      {text_with("[product.parameter]\nname = \"ID\"\npattern = \"a\"\nexample = \"b\"", "", kPlain),
       "c.toml:13: 'example' does not match 'pattern'"},
      {text_with("", "", kPlain, "kind = \"sound\""), "c.toml:4: 'kind': expected elevation or image"},
      {text_with("", "", kPlain, "kind = \"elevation\""), "c.toml:1: 'datum' is missing"},
      {text_with("", "", kPlain, "kind = \"elevation\"\ndatum = \"sea\""),
       "c.toml:5: 'datum': 'sea' is not one"},
      {text_with("", "", kPlain, "kind = \"image\"\ndatum = \"areoid\""), "'datum': images have none"},
      {text_with("", "", kPlain) + text_with("", "", kPlain), "c.toml:14: there are two products 'p'"},
      {"[[product]]\nname = \"Bad Name\"\n", "c.toml:2: 'name': expected small letters"},
      {"[[product]]\nname = \"p\"\nbody = \"Krypton\"\n", "c.toml:3: 'body': 'Krypton' is not known"},
      {"product = 5\n", "c.toml:1: expected [[product]]"},
      {"product = [5]\n", "c.toml:1: expected [[product]]"},
  };
  for (const auto& [text, words] : bad)
    EXPECT_NE(problem_of(text).find(words), std::string::npos) << words << "\n" << problem_of(text);
}

TEST(GetCatalogue, FileNamesStayInTheFolder) {
  for (const char* name : {"", ".", "..", ".hidden", "a/b", "a\\b", "a\nb"})
    EXPECT_FALSE(is_plain_file_name(name));
  EXPECT_TRUE(is_plain_file_name("megt90n000eb.img"));
  for (const char* address :
       {"ftp://a/x", "https:///x", "https://", "http://a b/x", "file:///x", "HTTPS://a/x"})
    EXPECT_FALSE(is_web_address(address)) << address;
}

class GetChoice : public ::testing::Test {
 protected:
  std::string error_of(const std::vector<std::string>& words,
                       const std::vector<std::string>& tiles = {}) const {
    try {
      select_products(catalogue_, words, tiles);
    } catch (const UsageError& e) {
      return e.what();
    }
    return "";
  }
  std::vector<std::string> lines(const std::vector<std::string>& words, const std::string& folder = "d") const {
    std::vector<std::string> texts;
    for (const BuildLine& line : build_lines(select_products(catalogue_, words, {"00n270"}), folder))
      texts.push_back(line.text);
    return texts;
  }
  Catalogue catalogue_ = embedded_catalogue();
};

TEST_F(GetChoice, WordsAfterAProductAreItsParameters) {
  const auto selected = select_products(
      catalogue_, {"ctx", "E-036_N-28", "E000_N00", "mola16", "ctx", "E-036_N-28", "mola16"}, {});
  ASSERT_EQ(selected.size(), 3U);
  EXPECT_EQ(selected[0].choice.parameter, "E-036_N-28");
  EXPECT_EQ(selected[1].choice.parameter, "E000_N00");
  EXPECT_EQ(selected[2].product->name, "mola16");
}

TEST_F(GetChoice, MistakesAreExplained) {
  EXPECT_NE(error_of({"mola129"}).find("no product is called 'mola129'; did you mean mola128"),
            std::string::npos);
  EXPECT_NE(error_of({"krypton"}).find("'vpe get' lists"), std::string::npos);
  EXPECT_NE(error_of({"hirise"}).find("needs ID, such as DTEEC_"), std::string::npos);
  EXPECT_NE(error_of({"hirise", "mola16"}).find("'mola16' is none"), std::string::npos);
  EXPECT_NE(error_of({"mola16", "E000_N00"}).find("no product is called 'E000_N00'"), std::string::npos);
  EXPECT_NE(error_of({"mola128"}, {"00n271"}).find("no such tile; there are 88n000"), std::string::npos);
  EXPECT_NE(error_of({"mola16"}, {"00n270"}).find("no product named here has tiles"), std::string::npos);
  EXPECT_NE(error_of({"hirise", "DTEEC_000823_1720_000824_1720_A01"}).find("precedes"), std::string::npos);
}

TEST_F(GetChoice, TilesLimitTheFiles) {
  const auto selected = select_products(catalogue_, {"mola128", "mola4"}, {"44s090", "00n270", "44s090"});
  ASSERT_EQ(selected[0].files.size(), 4U);
  EXPECT_TRUE(selected[0].files[0].address.ends_with("megt44s090hb.lbl"));
  EXPECT_TRUE(selected[0].files[3].address.ends_with("megt00n270hb.img"));
  EXPECT_EQ(selected[1].files.size(), 2U);
}

TEST_F(GetChoice, LinesForBuildAreComplete) {
  EXPECT_EQ(
      lines({"mola128", "viking925"}),
      (std::vector<std::string>{"vpe build d/megt00n270hb.lbl --image d/Mars_Viking_ClrMosaic_global_925m.tif "
                                "--datum areoid --body Mars -o mola128.vpe"}));
  // Images come last; each body has its planet; ZIP archives are read as they are.
  EXPECT_EQ(lines({"viking925", "mola128", "mercury665", "gebco2024"}).size(), 3U);
  EXPECT_EQ(lines({"viking925", "mola128"}), lines({"mola128", "viking925"}));
  EXPECT_NE(lines({"mola128", "gebco2024"})[1].find(
                "vpe build /vsizip/d/gebco_2024_geotiff.zip/gebco_2024_n90.0_s0.0_w-180.0_e-90.0.tif /vsizip/"),
            std::string::npos);
  EXPECT_TRUE(lines({"mola128"}, "my data")[0].starts_with("vpe build 'my data/megt00n270hb.lbl' --datum"));
  const std::string image = lines({"mola128", "wac100"})[1];
  EXPECT_TRUE(image.starts_with("vpe build ELEVATION --image d/Lunar_")) << image;
}

TEST(GetBuildLine, DifferentDatumsAreNamedOneByOne) {
  Catalogue catalogue = parse_catalogue(text_with("", "", kPlain), "c");
  catalogue.push_back(catalogue[0]);
  catalogue[1].name = "q";
  catalogue[1].datum = "sphere:3396190";
  catalogue[1].files[0].address = "https://a.org/y.img";
  EXPECT_EQ(
      build_lines(select_products(catalogue, {"p", "q"}, {}), "d")[0].text,
      "vpe build d/x.img d/y.img --datum d/x.img=areoid --datum d/y.img=sphere:3396190 --body Mars -o p.vpe");
}

TEST(GetBuildLine, WordsAreQuotedForAShell) {
  EXPECT_EQ(shell_word("a/b-c_1.img"), "a/b-c_1.img");
  EXPECT_EQ(shell_word("it's $HOME"), R"('it'\''s $HOME')");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace vpe::app
