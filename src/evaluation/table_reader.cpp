// SPDX-License-Identifier: MIT
//
// The only file that includes the CSV library, which reports errors by exceptions: they are caught here.
#include "evaluation/table_reader.h"

#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

#include <algorithm>
#include <utility>

namespace embody::evaluation {
namespace {

using Reader = io::CSVReader<max_columns, io::trim_chars<' ', '\t'>, io::double_quote_escape<',', '"'>>;

template <std::size_t... I>
void read_header(Reader& reader, const ColumnNames& names, std::index_sequence<I...>) {
    // The library needs a name for every column; unused columns get a name that no table has.
    const auto name_of = [&](std::size_t i) { return names[i].empty() ? "\x01" + std::to_string(i) : names[i]; };
    reader.read_header(io::ignore_extra_column | io::ignore_missing_column, name_of(I)...);
}

template <std::size_t... I>
bool read_row(Reader& reader, TableRow& row, std::index_sequence<I...>) {
    return reader.read_row(row.cells[I]...);
}

}  // namespace

Result<void> read_table(const std::filesystem::path& file, const ColumnNames& names, std::size_t required_columns,
                        const std::function<Result<void>(const TableRow&)>& take) {
    constexpr auto columns = std::make_index_sequence<max_columns>();
    if (!std::filesystem::is_regular_file(file)) return Error{file.string(), "is not a file", "name a CSV file"};
    try {
        Reader reader(file.string());
        read_header(reader, names, columns);
        for (std::size_t i = 0; i < required_columns; ++i) {
            if (!reader.has_column(names[i]))
                return Error{file.string(), "has no column \"" + names[i] + "\"", "name it in the first line"};
        }
        TableRow row;
        while (read_row(reader, row, columns)) {
            row.line = reader.get_file_line();
            if (const auto taken = take(row); !taken) {
                return Error{file.string() + ", line " + std::to_string(row.line) + ": " + taken.error().where,
                             taken.error().why, taken.error().remedy};
            }
            row.cells.fill({});
        }
    } catch (const io::error::base& broken) {
        return Error{file.string(), broken.what(), "check its quotes and the number of columns"};
    }
    return {};
}

std::vector<std::string> split_cell(const std::string& cell) {
    std::vector<std::string> parts;
    for (std::size_t first = 0; first < cell.size();) {
        const std::size_t end = std::min(cell.find(';', first), cell.size());
        const std::size_t start = std::min(cell.find_first_not_of(' ', first), end);
        const std::size_t last = cell.find_last_not_of(' ', end - 1);
        if (start < end) parts.push_back(cell.substr(start, last - start + 1));
        first = end + 1;
    }
    return parts;
}

}  // namespace embody::evaluation
