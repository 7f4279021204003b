// PLY files before assimp sees them: it reads for ever, or past the end, where a file ends early.
#pragma once

#include <filesystem>

namespace objects {

// Throws Refusal unless the header of a PLY is whole, and as many numbers follow as it claims. Does not keep them.
void check_ply(const std::filesystem::path& path);

}  // namespace objects
