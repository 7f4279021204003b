// Images of models with their alpha channel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "objects/model/mesh.h"

namespace objects {

// Decodes a PNG or JPEG, which its content tells apart. The row at the top comes first. Throws Refusal, with a reason
// that goes on from "the texture NAME", for other or damaged data and for more than most_texels, before memory is
// allocated for them.
Texture decode_texture(std::span<const std::uint8_t> bytes, std::size_t most_texels);

}  // namespace objects
