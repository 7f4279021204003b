// Parser of the texts that describe a sun.
#include <charconv>
#include <chrono>
#include <cmath>

#include "mars/geodesy/mars_time.h"

namespace mars {

namespace {

constexpr double kDaySeconds = 86400;

// Consumes a text from its front. A failed call consumes nothing.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  bool is_at_end() const { return rest_.empty(); }

  bool skip(char letter) {
    const bool is_there = !rest_.empty() && lower(rest_.front()) == letter;
    if (is_there) rest_.remove_prefix(1);
    return is_there;
  }

  // Reads a number of exactly `count` digits.
  std::optional<int> digits(std::size_t count) {
    if (rest_.size() < count) return std::nullopt;
    int value = 0;
    for (const char c : rest_.substr(0, count)) {
      if (c < '0' || c > '9') return std::nullopt;
      value = 10 * value + (c - '0');
    }
    rest_.remove_prefix(count);
    return value;
  }

  // Reads digits and at most one point, without sign and exponent.
  std::optional<double> number() {
    const std::string_view text = rest_.substr(0, rest_.find_first_not_of("0123456789."));
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    rest_.remove_prefix(text.size());
    return value;
  }

  bool has_digit_next() const { return !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9'; }

  static char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

 private:
  std::string_view rest_;
};

struct Clock {
  int hour = 0;
  int minute = 0;
  double second = 0;
  double seconds() const { return 3600.0 * hour + 60.0 * minute + second; }
};

// Reads HH:MM[:SS[.sss]] with hours to 24 and seconds below 61.
std::optional<Clock> read_clock(Reader& in) {
  const auto hour = in.digits(2);
  if (!hour || !in.skip(':')) return std::nullopt;
  const auto minute = in.digits(2);
  if (!minute) return std::nullopt;
  Clock clock{*hour, *minute, 0};
  if (in.skip(':')) {
    const auto whole = in.digits(2);
    if (!whole) return std::nullopt;
    clock.second = *whole;
    if (in.skip('.')) {
      double place = 0.1;
      if (!in.has_digit_next()) return std::nullopt;
      for (; in.has_digit_next(); place /= 10) clock.second += place * *in.digits(1);
    }
  }
  const bool is_good = clock.hour <= 24 && clock.minute < 60 && clock.second < 61;
  return is_good ? std::optional(clock) : std::nullopt;
}

// Holds the sun, or else a message.
struct Parsed {
  std::optional<SunSpec> sun;
  std::string problem;
};

Parsed read_season(Reader in) {
  const auto longitude = in.number();
  if (!longitude || !(*longitude <= 360)) {
    return {{}, "expected a solar longitude from 0 to 360 after Ls"};
  }
  if (!in.skip(',')) return {{}, "expected a comma and the local true solar time after the solar longitude"};
  const auto clock = read_clock(in);
  if (!clock || !in.is_at_end() || clock->seconds() > kDaySeconds || clock->second >= 60) {
    return {{}, "expected a local true solar time from 00:00 to 24:00, as 15:00 or 15:00:30"};
  }
  return {SunSeason{*longitude, clock->seconds() / 3600}, {}};
}

Parsed read_date(Reader in) {
  const auto year = in.digits(4);
  const bool has_year = year && in.skip('-');
  const auto month = has_year ? in.digits(2) : std::nullopt;
  const bool has_month = month && in.skip('-');
  const auto day = has_month ? in.digits(2) : std::nullopt;
  if (!day) return {{}, "neither local nor a date nor Ls and a time"};
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  constexpr int kFirstYear = 1900;
  constexpr int kLastYear = 2199;
  if (*year < kFirstYear || *year > kLastYear) return {{}, "expected a year from 1900 to 2199"};
  if (!date.ok()) return {{}, "there is no such day"};
  double seconds = kDaySeconds * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  if (in.is_at_end()) return {SunDate{seconds}, {}};
  if (!in.skip('t')) return {{}, "expected T and a time after the date, or nothing"};
  const auto clock = read_clock(in);
  const bool is_leap = clock && clock->second >= 60;
  const bool is_good =
      clock && clock->seconds() <= kDaySeconds + (is_leap ? 1 : 0) && (!is_leap || clock->minute == 59);
  if (!is_good) return {{}, "expected a time from 00:00 to 24:00, as 12:00, 12:00:30 or 12:00:30.5"};
  seconds += clock->seconds();
  if (in.is_at_end() || (in.skip('z') && in.is_at_end())) return {SunDate{seconds}, {}};
  const double sign = in.skip('+') ? 1 : in.skip('-') ? -1 : 0;
  const auto hours = in.digits(2);
  const bool has_colon = in.skip(':');
  const auto minutes = hours && has_colon ? in.digits(2) : std::nullopt;
  if (sign == 0 || !minutes || *hours > 14 || *minutes > 59 || !in.is_at_end()) {
    return {{}, "expected Z or an offset as +02:00 after the time, or nothing"};
  }
  return {SunDate{seconds - sign * (3600.0 * *hours + 60.0 * *minutes)}, {}};
}

Parsed read_sun(std::string_view text) {
  std::string small;
  for (const char c : text.substr(0, 64)) small += Reader::lower(c);
  if (text.size() <= 64 && small == "local") return {LocalSun{}, {}};
  if (small.rfind("ls", 0) == 0) return read_season(Reader(text.substr(2)));
  return read_date(Reader(text));
}

}  // namespace

std::optional<SunSpec> parse_sun(std::string_view text) { return read_sun(text).sun; }

std::string sun_problem(std::string_view text) { return read_sun(text).problem; }

std::string sun_grammar() {
  return "local, a date as 2026-11-20T12:00Z, or Ls90,15:00 (solar longitude in degrees and local true solar "
         "time)";
}

}  // namespace mars
