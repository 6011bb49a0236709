// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "interchange/file_source.h"

namespace embody::interchange {

/// Why a model file that was refused is wrong, found by looking at it: where it breaks off, which field refers to what
/// is not there, that it is of another format. Libraries often say no more than that they give up. `path` is the
/// model's in `source`, `bytes` its content, `told` what the library said, which is the answer where nothing better is
/// found.
std::string reason_of_refusal(const FileSource& source, const std::string& path, std::span<const std::uint8_t> bytes,
                              const std::string& told);

}  // namespace embody::interchange
