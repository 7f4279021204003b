#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/get/build_line.h"
#include "vpe/app/get/commands.h"
#include "vpe/app/get/fetch.h"
#include "vpe/app/get/listing.h"
#include "vpe/app/get/selection.h"

namespace vpe::app {

namespace {

namespace fs = std::filesystem;

struct GetArguments {
  std::vector<std::string> words;
  std::vector<std::string> tiles;
  std::string output;
  std::string catalogue;
  bool is_about = false;
  bool skips_checksums = false;
  FetchOptions options;
};

void list_products(const Catalogue& catalogue, const Common& common) {
  if (common.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const Product& product : catalogue) list.push_back(product_json(product));
    print_json(list);
  } else {
    std::fputs(catalogue_listing(catalogue).c_str(), stdout);
  }
}

void describe_products(const Catalogue& catalogue, const GetArguments& arguments, const Common& common) {
  Catalogue chosen;
  for (const std::string& word : arguments.words) {
    // The word that chooses a file of the product before it.
    if (!chosen.empty() && chosen.back().parameter && matches_parameter(*chosen.back().parameter, word))
      continue;
    chosen.push_back(require_product(catalogue, word));
  }
  if (common.json) {
    list_products(chosen, common);
    return;
  }
  for (const Product& product : chosen) std::fputs(product_text(product).c_str(), stdout);
}

#ifdef VPE_HAS_FETCH

std::string size_words(std::int64_t bytes) {
  constexpr std::int64_t kSmall_bytes = 100'000;
  return bytes < kSmall_bytes ? std::to_string(bytes) + " bytes" : bytes_text(static_cast<double>(bytes));
}

// Fails early if the disk is too small for all files.
void require_space(const std::vector<SelectedProduct>& selected, const GetArguments& arguments) {
  double needed = 0;
  for (const SelectedProduct& s : selected) {
    for (const RemoteFile& file : s.files)
      needed += static_cast<double>(bytes_to_fetch(file, arguments.output, arguments.options));
  }
  std::error_code none;
  const fs::space_info space = fs::space(arguments.output, none);
  if (none || needed <= static_cast<double>(space.available)) return;
  throw std::runtime_error("'" + arguments.output + "': " + bytes_text(needed) +
                           " are to be fetched, but only " + bytes_text(static_cast<double>(space.available)) +
                           " are free; choose another folder, or free some space");
}

nlohmann::json file_json(const SelectedProduct& s, const RemoteFile& file, const FetchedFile& fetched) {
  return {{"product", s.product->name},
          {"address", file.address},
          {"path", fetched.path.string()},
          {"bytes", fetched.bytes},
          {"kept", fetched.is_kept},
          {"checksum", fetched.checksum.empty() ? nlohmann::json(nullptr) : nlohmann::json(fetched.checksum)}};
}

void print_fetched(const std::vector<BuildLine>& lines, const nlohmann::json& files, const Common& common) {
  if (common.json) {
    nlohmann::json texts = nlohmann::json::array();
    for (const BuildLine& line : lines) texts.push_back(line.text);
    print_json({{"files", files}, {"build", texts}});
    return;
  }
  for (const BuildLine& line : lines) std::printf("%s\n", line.text.c_str());
}

// Says which word of a line is to be replaced.
void explain_line(const BuildLine& line, const Catalogue& catalogue) {
  if (line.text.find(std::string(" ") + kNoElevation + " ") == std::string::npos) return;
  std::string names;
  for (const Product& product : catalogue) {
    if (product.body == line.body && !product.is_image) names += (names.empty() ? "" : ", ") + product.name;
  }
  std::fprintf(stderr, "vpe: note: %s stands for a raster of elevation%s%s\n", kNoElevation,
               names.empty() ? "" : ", such as ", names.c_str());
}

void fetch_products(const Catalogue& catalogue, const GetArguments& arguments, const Common& common) {
  const std::vector<SelectedProduct> selected = select_products(catalogue, arguments.words, arguments.tiles);
  const InterruptGuard guard;
  make_folder(arguments.output);
  require_space(selected, arguments);
  std::size_t count = 0;
  for (const SelectedProduct& s : selected) count += s.files.size();
  nlohmann::json files = nlohmann::json::array();
  std::size_t number = 0;
  for (const SelectedProduct& s : selected) {
    for (const RemoteFile& file : s.files) {
      ++number;
      FetchedFile fetched;
      {
        ProgressLine line(common.quiet);
        const std::string place = count > 1 ? std::to_string(number) + "/" + std::to_string(count) + " " : "";
        fetched = fetch_file(file, arguments.output, arguments.options,
                             [&](const std::string& what, std::int64_t bytes) {
                               const auto done = static_cast<double>(bytes);
                               const double all = static_cast<double>(file.about_bytes);
                               line.show(what + " " + place + file.name + " (" + bytes_text(done) + ")",
                                         all > 0 ? std::min(1.0, done / all) : 0.0);
                             });
      }
      if (!common.quiet) {
        std::fprintf(stderr, "vpe: '%s': %s%s%s\n", fetched.path.c_str(),
                     fetched.is_kept ? "is there, kept" : size_words(fetched.bytes).c_str(),
                     fetched.checksum.empty() ? "" : ", the checksum is right",
                     fetched.is_kept ? " (--force fetches it anew)" : "");
      }
      files.push_back(file_json(s, file, fetched));
    }
  }
  const std::vector<BuildLine> lines = build_lines(selected, arguments.output);
  for (const BuildLine& line : lines) {
    if (!common.quiet) explain_line(line, catalogue);
  }
  print_fetched(lines, files, common);
}

#else

void fetch_products(const Catalogue& catalogue, const GetArguments& arguments, const Common&) {
  select_products(catalogue, arguments.words, arguments.tiles);
  throw std::runtime_error(
      "this build cannot fetch: it was made without libcurl; fetch the addresses that 'vpe get NAME --about' "
      "tells with another program, or build with libcurl4-openssl-dev and libssl-dev");
}

#endif

void get(GetArguments& arguments, const Common& common) {
  const Catalogue catalogue =
      arguments.catalogue.empty() ? embedded_catalogue() : read_catalogue(arguments.catalogue);
  arguments.options.quiet = common.quiet;
  arguments.options.uses_checksums = !arguments.skips_checksums;
  if (arguments.words.empty()) {
    if (arguments.is_about || !arguments.output.empty())
      throw UsageError("get: name a product; 'vpe get' lists them");
    list_products(catalogue, common);
  } else if (arguments.is_about) {
    describe_products(catalogue, arguments, common);
  } else if (arguments.output.empty()) {
    select_products(catalogue, arguments.words, arguments.tiles);
    throw UsageError("get: say with -o DIR where the files go, or give --about to read about them");
  } else {
    fetch_products(catalogue, arguments, common);
  }
}

}  // namespace

void add_get(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<GetArguments>();
  CLI::App* command =
      add_command(program, "get", "List and fetch public data to build planet files of", common, true);
  FetchOptions& o = arguments->options;
  command->add_option(
      "PRODUCT", arguments->words,
      "Short names of products, each with its ID or tile if it needs one; without any: list them all");
  command->add_option("-o,--output", arguments->output, "Folder for the files; made if it does not exist");
  command->add_flag("--about", arguments->is_about,
                    "Tell all that the catalogue says of the products, fetch nothing");
  command->add_option("--tile", arguments->tiles, "Fetch only this tile of products with tiles (repeatable)")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--catalogue", arguments->catalogue,
                      "TOML file to use in place of the program's catalogue");
  command->add_flag("--force", o.is_forced, "Fetch finished files anew");
  command->add_flag("--check", o.checks_kept, "Verify the checksums of finished files too");
  command->add_flag("--no-checksum", arguments->skips_checksums, "Verify no checksums");
  command->add_option("--retries", o.retries, "Failures in a row, without progress, after which it is given up")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command
      ->add_option("--retry-wait", o.retry_wait_s, "Pause after the first failure, seconds; doubles each time")
      ->check(number_within(0, 3600))
      ->capture_default_str();
  command->add_option("--connect-timeout", o.http.connect_s, "Time to connect to a server, seconds")
      ->check(number_within(0.1, 3600))
      ->capture_default_str();
  command
      ->add_option("--stall-timeout", o.http.stall_s,
                   "Time after which a server that sends nothing counts as hung, seconds")
      ->check(number_within(1, 3600))
      ->capture_default_str();
  add_examples(
      *command,
      {{"what there is", "vpe get"},
       {"all about one product", "vpe get mola128 --about"},
       {"elevation and imagery for a first planet of real data", "vpe get mola16 viking925 -o mars-data"},
       {"two of the sixteen tiles of a product", "vpe get mola128 --tile 44n270 --tile 00n270 -o mars-data"},
       {"a HiRISE DTM by its product ID", "vpe get hirise DTEEC_041277_2115_040776_2115_A01 -o mars-data"}});
  command->callback([arguments, &common] { get(*arguments, common); });
}

}  // namespace vpe::app
