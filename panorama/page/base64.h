// Bytes as text for scripts and data addresses (RFC 4648, section 4).
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace panorama {

// Returns the bytes in base64, padded, without line breaks. Pure.
std::string to_base64(std::span<const std::uint8_t> bytes);

}  // namespace panorama
