// Targets of the fuzzers: functions of any bytes that must never crash, loop, or give wrong results. A broken
// promise ends the process, as fuzzers expect.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace fuzz {

using Bytes = std::vector<std::uint8_t>;

// Describes one target.
struct Target {
  const char* name;
  void (*run)(std::span<const std::uint8_t> bytes);
  std::vector<Bytes> (*seeds)();  // well-formed inputs to start from
};

// Parses flights with parse_flight(). What it accepts survives to_text().
extern const Target kFlight;

// Decodes payloads of a planet file; the first byte selects the decoder. What is decoded survives encoding.
extern const Target kPayload;

// Opens whole planet files, reads every payload and runs verify().
extern const Target kPlanet;

// Changes values, payloads and the schema of a planet file, computes all checksums again, then reads, verifies and
// queries it. The bytes select the changes.
extern const Target kForged;

// Parses labels of PDS images, derives their placement, and opens the image with the label attached, as a user
// does.
extern const Target kLabel;

// Reads the metadata of panoramas: labels of rover mosaics (the first byte selects PDS3 and VICAR, or PDS4),
// XMP of GPano, JSON sidecars. What is read can be used, and survives being written.
extern const Target kRover;
extern const Target kGpano;
extern const Target kSidecar;

// Reads places and coordinates in the notations of maps, and tables of places with and without a header. What is
// read is within limits, and places survive being written.
extern const Target kPlace;
extern const Target kTable;

// Corrects systems of authority IAU_2015 for georeferences of any numbers: latitudes run along the axis that can
// have them.
extern const Target kAxes;

// Reads PNG, JPEG and TIFF as panoramas and planes: headers, views, rows, and inserting an XMP packet.
extern const Target kImage;

// Reads scene files: the first byte selects TOML or GeoJSON. What is read is within limits, messages name the file.
extern const Target kScene;

// Reads files of reliefs: the first byte selects TOML or a line of a flight. What is read can be placed, or there is a reason,
// survives being written, and changes heights within its bounds.
extern const Target kRelief;

// Reads models of sticks and casts rays at them.
extern const Target kSticks;

// Reads what vpe-model-reader sends.
extern const Target kMesh;

// Reads volumes and casts rays through them.
extern const Target kVolume;

// Ends the process with the message when `promise` does not hold.
void require(bool promise, const char* message);

}  // namespace fuzz
