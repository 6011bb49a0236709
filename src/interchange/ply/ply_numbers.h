// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interchange/ply/ply_header.h"

namespace embody::interchange {

/// The numbers of a PLY file one after another, in any of its encodings.
class PlyNumbers {
public:
    /// `file`: the whole file, `header`: its header.
    PlyNumbers(std::string_view file, const PlyHeader& header)
        : left_(file.substr(header.size)),
          file_size_(file.size()),
          encoding_(header.encoding),
          line_(header.lines + 1) {}

    /// The next number; empty where the file ends or has something else there.
    std::optional<double> next(PlyType type);
    /// The next list, counted as the property says; false where next() would give nothing, or the count is none.
    bool next_list(const PlyProperty& property, std::vector<double>& list);
    /// The present place in the file, for people: "line 12" or "byte 3456".
    [[nodiscard]] std::string place() const;

private:
    std::optional<double> next_in_text();

    std::string_view left_;
    std::size_t file_size_;
    PlyEncoding encoding_;
    std::size_t line_;
};

}  // namespace embody::interchange
