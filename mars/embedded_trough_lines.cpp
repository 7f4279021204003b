#include <array>

#include "mars/embedded_math.h"
#include "mars/embedded_troughs.h"

namespace mars::embedded {

namespace {

struct Node {
  double lon_deg, lat_deg, half_width_km, floor_m;
};

constexpr TroughPiece piece(const Node& a, const Node& b) {
  return {place(a.lon_deg, a.lat_deg),
          place(b.lon_deg, b.lat_deg),
          a.half_width_km,
          b.half_width_km,
          a.floor_m,
          b.floor_m};
}

// Joins consecutive nodes of several lines; a node of negative width starts a new line.
template <std::size_t kNodes>
constexpr std::size_t count_pieces(const Node (&nodes)[kNodes]) {
  std::size_t n = 0;
  for (std::size_t i = 1; i < kNodes; ++i)
    n += nodes[i].half_width_km > 0.0 && nodes[i - 1].half_width_km > 0.0;
  return n;
}

template <std::size_t kPieces, std::size_t kNodes>
constexpr std::array<TroughPiece, kPieces> join(const Node (&nodes)[kNodes]) {
  std::array<TroughPiece, kPieces> pieces{};
  std::size_t n = 0;
  for (std::size_t i = 1; i < kNodes; ++i) {
    if (nodes[i].half_width_km > 0.0 && nodes[i - 1].half_width_km > 0.0)
      pieces[n++] = piece(nodes[i - 1], nodes[i]);
  }
  return pieces;
}

constexpr Node kEnd{0, 0, -1, 0};

constexpr Node kVallesNodes[] = {
    // Ius: two parallel troughs with Geryon Montes between.
    {267.8, -6.3, 12, 1500},
    {271.0, -6.7, 20, -800},
    {274.5, -7.0, 26, -2400},
    {278.0, -7.5, 24, -3300},
    {281.5, -8.2, 26, -3900},
    {284.8, -9.2, 40, -4300},
    kEnd,
    {272.5, -7.9, 10, 600},
    {275.6, -8.3, 17, -2200},
    {279.0, -8.9, 19, -3100},
    {282.5, -9.6, 24, -3900},
    {285.5, -10.2, 40, -4400},
    kEnd,
    // Tithonium
    {268.8, -5.4, 8, 2200},
    {271.5, -5.0, 16, 200},
    {274.0, -4.7, 22, -1400},
    {276.5, -4.6, 26, -2600},
    {279.0, -4.8, 34, -3300},
    {281.8, -5.2, 42, -3900},
    {283.6, -5.6, 30, -3300},
    kEnd,
    // Melas
    {284.0, -9.6, 46, -4300},
    {285.9, -10.3, 85, -4700},
    {287.5, -10.5, 105, -4900},
    {289.5, -11.0, 92, -4800},
    {291.8, -11.7, 56, -4600},
    kEnd,
    // Candor, west and east, joined to Melas; Ophir
    {284.2, -6.2, 38, -3300},
    {286.0, -6.3, 60, -3900},
    {288.0, -6.4, 56, -4200},
    {290.0, -6.8, 62, -4100},
    {291.8, -7.4, 66, -3900},
    {293.6, -8.0, 40, -3000},
    kEnd,
    {287.4, -6.9, 62, -4200},
    {287.6, -8.6, 58, -4600},
    {287.5, -9.8, 70, -4800},
    kEnd,
    {285.7, -4.3, 34, -3600},
    {287.6, -4.0, 50, -4100},
    {290.0, -4.3, 44, -3900},
    {291.3, -4.8, 24, -2800},
    kEnd,
    {287.9, -4.4, 44, -4100},
    {288.4, -6.2, 46, -4100},
    kEnd,
    // Coprates and its southern catena
    {291.8, -11.7, 46, -4600},
    {294.5, -12.4, 40, -4900},
    {297.0, -12.9, 42, -5100},
    {299.3, -13.4, 44, -5300},
    {301.8, -13.6, 43, -5200},
    {304.3, -13.9, 50, -4900},
    {307.0, -13.8, 66, -4600},
    {309.5, -13.7, 78, -4300},
    kEnd,
    {298.0, -15.0, 7, -900},
    {300.2, -15.3, 11, -1900},
    {302.5, -15.5, 9, -1200},
    kEnd,
    // Capri and Eos
    {309.5, -13.0, 60, -4300},
    {312.5, -11.7, 66, -4200},
    {315.2, -9.9, 72, -4200},
    {317.9, -8.3, 78, -4200},
    {320.2, -6.0, 66, -4100},
    {321.8, -3.2, 58, -4000},
    kEnd,
    {309.5, -14.3, 62, -4300},
    {313.0, -14.9, 54, -4200},
    {316.5, -14.2, 58, -4100},
    {319.2, -12.9, 66, -4100},
    {320.83, -12.15, 68, -4000},
    {322.6, -10.0, 56, -3900},
    {322.8, -7.0, 52, -4000},
    kEnd,
    // Ganges, closed Hebes, Juventae
    {307.2, -7.0, 22, -2600},
    {309.3, -7.5, 48, -3700},
    {312.1, -8.0, 66, -4000},
    {314.6, -8.6, 56, -4000},
    {316.6, -8.4, 46, -4000},
    kEnd,
    {281.6, -1.2, 24, -2800},
    {283.9, -1.0, 52, -3900},
    {286.6, -1.25, 14, -2300},
    kEnd,
    {298.3, -4.6, 36, -3800},
    {298.6, -3.0, 52, -4300},
    {298.3, -0.8, 44, -3200},
    {298.0, 1.0, 26, -1400},
    kEnd,
};
constexpr auto kValles = join<count_pieces(kVallesNodes)>(kVallesNodes);

constexpr Node kChannelNodes[] = {
    // Echus and Kasei
    {279.8, 4.0, 40, 400},
    {281.0, 7.5, 66, -100},
    {282.5, 12.0, 80, -500},
    {284.0, 17.5, 85, -900},
    {287.0, 20.5, 80, -1300},
    {292.0, 21.0, 70, -1700},
    {297.0, 23.0, 85, -2300},
    {301.5, 25.5, 90, -3000},
    {306.0, 27.0, 100, -3500},
    kEnd,
    {284.5, 22.0, 40, -800},
    {287.5, 25.0, 45, -1200},
    {292.5, 25.8, 45, -1800},
    {298.0, 25.8, 55, -2500},
    {303.5, 27.0, 60, -3200},
    kEnd,
    // Maja
    {300.6, 4.0, 30, -300},
    {302.0, 9.0, 35, -900},
    {303.8, 14.0, 38, -1400},
    {305.6, 17.5, 40, -2100},
    {309.0, 19.5, 50, -2900},
    kEnd,
    // Simud and Tiu out of the chaos east of Valles Marineris
    {321.5, -3.0, 60, -3950},
    {321.5, 2.0, 66, -3900},
    {321.0, 8.0, 70, -3850},
    {322.5, 14.0, 80, -3850},
    {324.0, 19.0, 100, -3850},
    kEnd,
    {322.8, -7.0, 60, -3950},
    {325.0, -2.0, 58, -3900},
    {326.5, 4.0, 60, -3850},
    {326.0, 10.0, 66, -3850},
    {327.0, 16.0, 80, -3850},
    kEnd,
    // Ares
    {341.8, -2.5, 55, -2700},
    {342.5, 3.0, 40, -2800},
    {340.0, 7.0, 42, -3100},
    {335.5, 10.5, 46, -3450},
    {331.0, 15.5, 66, -3700},
    kEnd,
    // Mangala, Ma'adim, Dao, Harmakhis
    {210.0, -17.0, 10, 300},
    {209.0, -11.0, 14, -500},
    {207.5, -6.0, 20, -1500},
    {206.5, -3.5, 26, -2100},
    kEnd,
    {177.6, -27.5, 6, 600},
    {177.3, -23.0, 9, -500},
    {175.8, -18.5, 11, -1500},
    {175.4, -16.0, 13, -1900},
    kEnd,
    {93.5, -33.2, 16, -2600},
    {90.5, -35.8, 14, -3900},
    {86.5, -38.8, 13, -5300},
    {83.5, -40.6, 16, -6000},
    kEnd,
    {97.5, -38.0, 12, -2400},
    {93.0, -39.6, 12, -3700},
    {88.5, -41.8, 12, -5200},
    kEnd,
};
constexpr auto kChannels = join<count_pieces(kChannelNodes)>(kChannelNodes);

static_assert(kValles.size() <= kMostPieces && kChannels.size() <= kMostPieces);

}  // namespace

std::span<const TroughPiece> valles_pieces() { return kValles; }
std::span<const TroughPiece> channel_pieces() { return kChannels; }

}  // namespace mars::embedded
