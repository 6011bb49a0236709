// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "foundation/result.h"

namespace embody::evaluation {

/// Maximum number of columns that a reader asks for.
inline constexpr std::size_t max_columns = 10;

/// Columns of a table to read, in the order in which a row's cells are handed over; unused names are empty.
using ColumnNames = std::array<std::string, max_columns>;

/// One row: the cells of the named columns, empty where the table has no such column, and the line it stands in.
struct TableRow {
    std::array<std::string, max_columns> cells;
    unsigned line = 0;
};

/// Reads a comma-separated file with a header (RFC 4180 quotes on one line, UTF-8, further columns are ignored) and
/// calls `take` with row after row until it returns an error. Errors name the file and the line; the first
/// `required_columns` of `names` must be in the header.
Result<void> read_table(const std::filesystem::path& file, const ColumnNames& names, std::size_t required_columns,
                        const std::function<Result<void>(const TableRow&)>& take);

/// The parts of a cell that are separated by ";", without spaces around them; empty parts are left out.
std::vector<std::string> split_cell(const std::string& cell);

}  // namespace embody::evaluation
