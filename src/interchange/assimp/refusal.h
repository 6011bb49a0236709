// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "interchange/file_source.h"

namespace embody::interchange {

/// Why a refused model file is wrong, found by reading it: where it breaks off, which field refers to something
/// missing, or that it is of another format. Libraries often say only that they give up. `path` is the
/// model's in `source`, `bytes` its content, `told` the library's message, which is the answer where no better one is
/// found.
std::string reason_of_refusal(const FileSource& source, const std::string& path, std::span<const std::uint8_t> bytes,
                              const std::string& told);

}  // namespace embody::interchange
