// What the fuzzers feed: functions of any bytes that must never crash, loop, or answer wrongly. A broken
// promise ends the process, as fuzzers want it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace fuzz {

using Bytes = std::vector<std::uint8_t>;

struct Target {
  const char* name;
  void (*run)(std::span<const std::uint8_t> bytes);
  std::vector<Bytes> (*seeds)();  // well-formed inputs to start from
};

// Flights: parse_flight(), and that what it takes survives to_text().
extern const Target kFlight;

// The payloads of a planet file; the first byte chooses the decoder. What is decoded survives encoding.
extern const Target kPayload;

// Whole planet files: opening, every payload, verify().
extern const Target kPlanet;

// Labels of PDS images, the label being the image's own: parsing, placing, and opening as a user does.
extern const Target kLabel;

// What describes a panorama: labels of rover mosaics (the first byte chooses PDS3 and VICAR, or PDS4), GPano's
// XMP, the JSON beside an image. What is read can be used, and survives being written.
extern const Target kRover;
extern const Target kGpano;
extern const Target kSidecar;

// PNG, JPEG and TIFF as panoramas and planes: describing, looking, reading by rows, putting a packet in.
extern const Target kImage;

// Ends the process with the words when `promise` does not hold.
void require(bool promise, const char* words);

}  // namespace fuzz
